// SPDX-License-Identifier: BSD-3-Clause
// Messages and parameters to core types and back. Private to the node.
#pragma once

#include <prf_msgs/ControlStatus.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <prf_ros/private_parameters.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "prf_control/arm_controller.hpp"

namespace prf_control {

struct NodeParams {
  ArmControllerParams controller;
  std::array<std::string, 7> joint_names;
  std::string planning_frame;
  std::string hand_frame;
};

inline NodeParams read_params(const ros::NodeHandle& private_handle) {
  prf_ros::PrivateParameters values(private_handle);
  NodeParams params{};
  FollowerParams& follower = params.controller.follower;
  follower.velocity_scale = values.number("velocity_scale");
  follower.acceleration = values.number("acceleration");
  follower.max_joint_step = values.number("max_joint_step");
  follower.far_position = values.number("far_position");
  follower.far_orientation = values.number("far_orientation");
  follower.damping = values.number("damping");
  follower.orientation_weight = values.number("orientation_weight");
  follower.branch_patience = values.number("branch_patience");
  params.controller.max_tracking_error = values.number("max_tracking_error");
  params.controller.max_wait = values.number("max_wait");
  params.controller.joint_prefix = values.text("joint_prefix");
  params.planning_frame = values.text("planning_frame");
  params.hand_frame = values.text("hand_frame");
  values.refuse_unknown();

  for (const char* name : {"joint_prefix", "planning_frame", "hand_frame"}) {
    if (values.text(name).empty()) {
      throw std::invalid_argument(std::string(name) + " = '', must not be empty");
    }
  }
  params.controller.validate();
  for (std::size_t i = 0; i < params.joint_names.size(); ++i) {
    params.joint_names[i] = params.controller.joint_prefix + std::to_string(i + 1);
  }
  return params;
}

inline std::int64_t to_ns(const ros::Time& stamp) {
  return static_cast<std::int64_t>(stamp.toNSec());
}

// None when a joint of the arm is not in the message: other parts may publish joint_states too.
inline std::optional<JointSample> from_message(const sensor_msgs::JointState& message,
                                               const std::array<std::string, 7>& names) {
  JointSample sample;
  sample.stamp_ns = to_ns(message.header.stamp);
  JointVector position;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = std::find(message.name.begin(), message.name.end(), names[i]);
    const auto index = static_cast<std::size_t>(found - message.name.begin());
    if (index >= message.name.size() || index >= message.position.size()) return std::nullopt;
    position[static_cast<Eigen::Index>(i)] = message.position[index];
    if (!std::isfinite(message.position[index])) {
      sample.fault = "joint_states: position of " + names[i] + " is not finite";
    }
  }
  if (sample.fault.empty()) sample.position = position;
  return sample;
}

inline Eigen::Vector3d from_message(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }

inline Setpoint from_message(const trajectory_msgs::MultiDOFJointTrajectory& message,
                             const NodeParams& params) {
  if (message.points.empty()) return hold_setpoint();
  if (message.header.frame_id != params.planning_frame) {
    return refused_setpoint("frame_id '" + message.header.frame_id + "' must be '" +
                            params.planning_frame + "'");
  }
  if (message.joint_names != std::vector<std::string>{params.hand_frame}) {
    return refused_setpoint("joint_names must be ['" + params.hand_frame + "']");
  }
  const auto& point = message.points.front();
  if (message.points.size() != 1 || point.transforms.size() != 1 || point.velocities.size() > 1) {
    return refused_setpoint("must have one point with one transform and at most one velocity");
  }
  const geometry_msgs::Transform& pose = point.transforms.front();
  const geometry_msgs::Twist twist =
      point.velocities.empty() ? geometry_msgs::Twist() : point.velocities.front();
  return checked_setpoint(from_message(pose.translation),
                          {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w},
                          from_message(twist.linear), from_message(twist.angular));
}

inline std_msgs::Header header_of(const Answer& answer) {
  std_msgs::Header header;
  header.stamp.fromNSec(static_cast<std::uint64_t>(answer.stamp_ns));
  return header;
}

inline trajectory_msgs::JointTrajectory command_message(const Answer& answer,
                                                        const std::array<std::string, 7>& names) {
  trajectory_msgs::JointTrajectory message;
  message.header = header_of(answer);
  message.joint_names.assign(names.begin(), names.end());
  message.points.resize(1);
  auto& point = message.points.front();
  const MotionState& command = answer.command;
  point.positions.assign(command.position.data(), command.position.data() + names.size());
  point.velocities.assign(command.velocity.data(), command.velocity.data() + names.size());
  point.time_from_start = ros::Duration(0, 10'000'000);
  return message;
}

inline prf_msgs::ControlStatus status_message(const Answer& answer) {
  using Status = prf_msgs::ControlStatus;
  static_assert(Status::FOLLOWING == static_cast<int>(ControlCode::kFollowing) &&
                Status::HOLDING == static_cast<int>(ControlCode::kHolding) &&
                Status::LIMITED == static_cast<int>(ControlCode::kLimited) &&
                Status::UNREACHABLE == static_cast<int>(ControlCode::kUnreachable) &&
                Status::STALE_SETPOINT == static_cast<int>(ControlCode::kStaleSetpoint) &&
                Status::INVALID_SETPOINT == static_cast<int>(ControlCode::kInvalidSetpoint));
  Status message;
  message.header = header_of(answer);
  message.code = static_cast<std::uint8_t>(answer.code);
  message.reason = answer.reason;
  message.position_error = answer.position_error;
  message.orientation_error = answer.orientation_error;
  message.deviation = answer.deviation;
  return message;
}

}  // namespace prf_control
