// SPDX-License-Identifier: BSD-3-Clause
// Messages of arm_controller to the types of the core and back.
#pragma once

#include <prf_msgs/ControlStatus.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <optional>
#include <string>
#include <vector>

#include "params.hpp"
#include "prf_control/arm_controller.hpp"

namespace prf_control {

// A message that has no joint of the arm is no tick, but no error either: other parts of the robot
// may publish joint_states, too. One that has only some, or one twice, is refused.
struct JointReading {
  std::optional<JointSample> sample;
  std::string refusal;  // names what was expected and received
};
[[nodiscard]] JointReading to_sample(const sensor_msgs::JointState& message,
                                     const std::vector<std::string>& joint_names);

// Quoted, cut after 200 characters.
[[nodiscard]] std::string listed(const std::vector<std::string>& names);

[[nodiscard]] Setpoint to_setpoint(const trajectory_msgs::MultiDOFJointTrajectory& message,
                                   const NodeParams& params);

// Of a result that has a command.
[[nodiscard]] trajectory_msgs::JointTrajectory command_message(const ControlResult& result,
                                                               const NodeParams& params);

[[nodiscard]] prf_msgs::ControlStatus status_message(const ControlResult& result);

}  // namespace prf_control
