// SPDX-License-Identifier: BSD-3-Clause
// The parameters of arm_controller: what the controller needs, and the robot, which has the names
// in its messages.
#pragma once

#include <ros/node_handle.h>

#include <prf_robots/robot.hpp>
#include <vector>

#include "prf_control/arm_controller.hpp"

namespace prf_control {

struct NodeParams {
  ArmControllerParams controller;
  prf_robots::Robot robot;
  double tick_period;  // [s], 0.002 to 0.02; time_from_start of each command, and the rate at which
                       // joint_states is expected

  void validate() const;
};

// Throws std::invalid_argument for a parameter that is missing, unknown or out of bounds.
[[nodiscard]] NodeParams load_params(const ros::NodeHandle& private_handle);

}  // namespace prf_control
