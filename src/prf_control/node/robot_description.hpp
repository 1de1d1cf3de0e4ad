// SPDX-License-Identifier: BSD-3-Clause
// Whether the robot is the arm that jaco_kinematics was compiled for. Commands for another one
// would move it to places that mean nothing to it.
#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace prf_control {

struct ArmNames {
  std::vector<std::string> joints;  // seven, from base to hand
  std::string base;                 // link
  std::string hand;                 // link
};

// Compares a URDF with the kinematics: the joints between base and hand, their types, position and
// velocity limits (to 1e-3 rad, rad/s), their axes (to 1e-3 rad) and the pose of the hand (to
// 0.1 mm and 1e-3 rad) in several configurations. Throws std::invalid_argument with the first
// difference. Joint limits for velocity may be absent where the joint is continuous.
void require_same_arm(const std::string& urdf, const ArmNames& names);

// The parameter robot_description, searched upward from the node's namespace. Waits for it by wall
// clock; throws std::invalid_argument when it has not come after `patience` seconds.
[[nodiscard]] std::string wait_for_robot_description(const ros::NodeHandle& node, double patience);

}  // namespace prf_control
