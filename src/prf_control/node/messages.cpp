// SPDX-License-Identifier: BSD-3-Clause
#include "messages.hpp"

#include <algorithm>
#include <prf_core/quoted.hpp>
#include <prf_ros/conversions.hpp>

namespace prf_control {

using prf_ros::to_core;

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
    if (text.size() > prf_core::kMaxQuoted) break;
  }
  return prf_core::quoted(text);
}

JointReading to_sample(const sensor_msgs::JointState& message,
                       const std::vector<std::string>& joint_names) {
  const auto stamp = prf_ros::usable_stamp(message.header.stamp);
  if (!stamp) return {std::nullopt, "its stamp is beyond the bounds of time"};
  JointVector position(static_cast<Eigen::Index>(joint_names.size()));
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < joint_names.size(); ++i) {
    const std::string& name = joint_names[i];
    const auto found = std::find(message.name.begin(), message.name.end(), name);
    if (found == message.name.end()) {
      missing.push_back(name);
      continue;
    }
    if (std::find(found + 1, message.name.end(), name) != message.name.end()) {
      return {std::nullopt, "it names " + name + " twice"};
    }
    const auto index = static_cast<std::size_t>(found - message.name.begin());
    if (index >= message.position.size()) {
      return {std::nullopt, "it has " + std::to_string(message.name.size()) + " names and " +
                                std::to_string(message.position.size()) + " positions"};
    }
    position[static_cast<Eigen::Index>(i)] = message.position[index];
  }
  if (missing.size() == joint_names.size()) return {};
  if (!missing.empty()) {
    return {std::nullopt, "it lacks " + listed(missing) + ", has " + listed(message.name)};
  }
  return {checked_joints(*stamp, position, joint_names), ""};
}

Setpoint to_setpoint(const trajectory_msgs::MultiDOFJointTrajectory& message,
                     const NodeParams& params) {
  if (message.points.empty()) return hold_setpoint();
  if (message.header.frame_id != params.robot.base_link) {
    return refused_setpoint("frame_id " + prf_core::quoted(message.header.frame_id) + " must be '" +
                            params.robot.base_link + "'");
  }
  if (message.joint_names != std::vector<std::string>{params.robot.tip_link}) {
    return refused_setpoint("joint_names must be ['" + params.robot.tip_link + "']");
  }
  const auto& point = message.points.front();
  if (message.points.size() != 1 || point.transforms.size() != 1 || point.velocities.size() > 1) {
    return refused_setpoint("must have one point with one transform and at most one velocity");
  }
  const geometry_msgs::Transform& pose = point.transforms.front();
  const geometry_msgs::Twist twist =
      point.velocities.empty() ? geometry_msgs::Twist() : point.velocities.front();
  return checked_setpoint(to_core(pose.translation), to_core(pose.rotation).coeffs(),
                          to_core(twist.linear), to_core(twist.angular));
}

trajectory_msgs::JointTrajectory command_message(const ControlResult& result,
                                                 const NodeParams& params) {
  trajectory_msgs::JointTrajectory message;
  message.header.stamp = prf_ros::to_ros_time(result.stamp);
  message.joint_names = params.robot.joints;
  message.points.resize(1);
  auto& point = message.points.front();
  const auto& [position, velocity] = result.command.value();
  point.positions.assign(position.data(), position.data() + position.size());
  point.velocities.assign(velocity.data(), velocity.data() + velocity.size());
  point.time_from_start = ros::Duration(params.tick_period);
  return message;
}

prf_msgs::ControlStatus status_message(const ControlResult& result) {
  using Status = prf_msgs::ControlStatus;
  static_assert(Status::FOLLOWING == static_cast<int>(ControlCode::kFollowing) &&
                Status::HOLDING == static_cast<int>(ControlCode::kHolding) &&
                Status::LIMITED == static_cast<int>(ControlCode::kLimited) &&
                Status::UNREACHABLE == static_cast<int>(ControlCode::kUnreachable) &&
                Status::STALE_SETPOINT == static_cast<int>(ControlCode::kStaleSetpoint) &&
                Status::INVALID_SETPOINT == static_cast<int>(ControlCode::kInvalidSetpoint) &&
                Status::FAILING == static_cast<int>(ControlCode::kFailing));
  Status message;
  message.header.stamp = prf_ros::to_ros_time(result.stamp);
  message.code = static_cast<std::uint8_t>(result.code);
  message.reason = result.reason;
  message.position_error = result.position_error;
  message.orientation_error = result.orientation_error;
  message.deviation = result.deviation;
  return message;
}

}  // namespace prf_control
