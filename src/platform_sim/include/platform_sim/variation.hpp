// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "platform_sim/world.hpp"

namespace platform_sim {

/// What differs from trial to trial. At scale 1 each is drawn uniformly from +- these values, which
/// are chosen by hand.
struct VariationSpread {
  double box_position = 0.02;    ///< m, per axis
  double box_yaw = 0.05;         ///< rad, about the vertical through the tag
  double robot_position = 0.02;  ///< m, x and y of base_link at the start
  double robot_yaw = 0.05;       ///< rad
  double friction = 0.15;        ///< share of the coefficient
  double camera_noise = 0.25;    ///< share of the standard deviation
};

/// One draw.
struct Variation {
  Eigen::Vector3d box_position = Eigen::Vector3d::Zero();
  double box_yaw = 0.0;
  Eigen::Vector2d robot_position = Eigen::Vector2d::Zero();
  double robot_yaw = 0.0;
  double friction_factor = 1.0;
  double camera_noise_factor = 1.0;

  /// The same for the same seed. `scale` is from 0 (no variation) to 1, else
  /// std::invalid_argument.
  [[nodiscard]] static Variation draw(std::uint64_t seed, double scale,
                                      const VariationSpread& spread = {});

  /// Moves box and robot and changes the friction of a nominal world.
  void apply_to(WorldParams& config) const;
  /// In words, for the log.
  [[nodiscard]] std::string text() const;
};

}  // namespace platform_sim
