// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "v60_gait/leg_controller.hpp"
#include "v60_gait/leg_model.hpp"

namespace v60_gait {

/// Prefixes of the legs' links and joints, in the order of LegVector.
constexpr std::array<const char*, 4> kLegNames{"fl", "fr", "rl", "rr"};

[[nodiscard]] std::array<std::string, 12> leg_joint_names();

/// Standing posture: toes at (+-0.31, +-0.17, -0.506) m in base_link. These are the toes of a
/// standing Vision 60 with arm, as it logged them, made symmetric.
struct Stance {
  std::vector<LegModel> legs;                   ///< in the order of kLegNames
  std::array<Eigen::Vector3d, 4> toes_in_base;  ///< m
  LegVector posture;                            ///< rad
};

/// Throws std::invalid_argument if the robot has no such legs or they cannot reach
/// the toes' places.
[[nodiscard]] Stance find_stance(const RigidTree& robot);

/// What the legs carry.
struct BodyModel {
  double weight = 0.0;                                               ///< N, of the whole robot
  Eigen::Vector3d centre_of_mass_in_base = Eigen::Vector3d::Zero();  ///< m, of the whole robot
};

/// Torques, Nm, that carry the robot at rest in its stance on a level deck, by vertical forces at
/// the toes. Of the forces that balance the robot those with the least sum of squares are taken.
[[nodiscard]] LegVector standing_torques(const BodyModel& body, const Stance& stance);

}  // namespace v60_gait
