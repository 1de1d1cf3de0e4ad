// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "v60_gait/leg_controller.hpp"
#include "v60_gait/stance.hpp"

namespace v60_gait {

/// Turns the axes so that x points where the robot headed when it was first observed.
class StartHeading {
 public:
  [[nodiscard]] LegObservation relative(LegObservation observation);

 private:
  std::optional<Eigen::Quaterniond> heading_;
};

/// The feet as the legs' encoders and the inertial unit tell them: relative to the base's origin,
/// in axes with z up.
struct Feet {
  std::array<Eigen::Vector3d, 4> positions;   ///< m
  std::array<Eigen::Vector3d, 4> velocities;  ///< m/s
  std::array<Eigen::Matrix3d, 4> jacobians;   ///< of the positions by the leg's joints
  std::array<bool, 4> on_ground{true, true, true, true};
};

[[nodiscard]] Feet observe_feet(const Stance& stance, const LegObservation& observation,
                                const std::array<bool, 4>& on_ground);

/// Means over the feet on the ground, of which there must be one.
[[nodiscard]] Eigen::Vector3d body_over_feet(const Feet& feet);           ///< m
[[nodiscard]] Eigen::Vector3d body_velocity_over_feet(const Feet& feet);  ///< m/s

/// Pitch and roll, rad, of the plane under the feet. Feet i and j on it have
/// z_i - z_j = -pitch (x_i - x_j) + roll (y_i - y_j). One diagonal pair cannot tell the two apart,
/// two pairs in turn can.
class SlopeEstimate {
 public:
  void update(const Feet& feet, double duration);
  [[nodiscard]] const Eigen::Vector2d& slope() const { return slope_; }

 private:
  Eigen::Vector2d slope_ = Eigen::Vector2d::Zero();
};

}  // namespace v60_gait
