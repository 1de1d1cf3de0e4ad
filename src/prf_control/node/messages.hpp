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

// None when a joint of the arm is not in the message: other parts may publish joint_states too.
[[nodiscard]] std::optional<JointSample> to_sample(const sensor_msgs::JointState& message,
                                                   const std::vector<std::string>& joint_names);

[[nodiscard]] Setpoint to_setpoint(const trajectory_msgs::MultiDOFJointTrajectory& message,
                                   const NodeParams& params);

[[nodiscard]] trajectory_msgs::JointTrajectory command_message(
    const ControlResult& result, const std::vector<std::string>& joint_names);

[[nodiscard]] prf_msgs::ControlStatus status_message(const ControlResult& result);

}  // namespace prf_control
