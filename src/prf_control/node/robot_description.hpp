// SPDX-License-Identifier: BSD-3-Clause
// Whether the arm that is there is the robot whose kinematics the node has loaded. Commands for
// another one would move it to places that mean nothing to it.
#pragma once

#include <ros/node_handle.h>

#include <prf_robots/robot.hpp>
#include <string>

namespace prf_control {

// Compares the URDF of the arm that is there with the robot: the joints between base and tip, their
// position and velocity limits (to 1e-3 rad, rad/s), their axes (to 1e-3 rad) and the pose of the
// tip (to 0.1 mm and 1e-3 rad) in several configurations. Throws std::invalid_argument with the
// first difference.
void require_same_arm(const std::string& urdf, const prf_robots::Robot& robot);

// The parameter robot_description, searched upward from the node's namespace. Waits for it by wall
// clock; throws std::invalid_argument when it has not come after `patience` seconds.
[[nodiscard]] std::string wait_for_robot_description(const ros::NodeHandle& node, double patience);

}  // namespace prf_control
