// SPDX-License-Identifier: BSD-3-Clause
// Private: messages to core types and back. Messages that must not be acted on throw
// std::invalid_argument with the reason.
#pragma once

#include <prf_msgs/ExecutionProgress.h>
#include <prf_msgs/SkillTrajectory.h>
#include <prf_msgs/TargetForecast.h>
#include <ros/duration.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <algorithm>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "prf_decision/decision.hpp"

namespace prf_decision {

inline constexpr const char* kPlanningFrame = "j2s7s300_link_base";
inline constexpr const char* kHandFrame = "j2s7s300_end_effector";
inline const std::string kArmJoints = "j2s7s300_joint_";  // and 1 .. 7, from base to hand

inline Stamp to_core(const ros::Time& time) {
  return std::chrono::seconds(time.sec) + std::chrono::nanoseconds(time.nsec);
}

inline Duration to_core(const ros::Duration& duration) {
  return std::chrono::seconds(duration.sec) + std::chrono::nanoseconds(duration.nsec);
}

inline ros::Time to_ros_time(Stamp stamp) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(stamp.count()));
}

inline ros::Duration to_ros_duration(Duration duration) {
  return ros::Duration().fromNSec(duration.count());
}

inline Eigen::Vector3d to_core(const geometry_msgs::Vector3& vector) {
  return {vector.x, vector.y, vector.z};
}

inline Pose to_core(const geometry_msgs::Pose& message) {
  constexpr double kNormTolerance = 1e-2;
  const auto& q = message.orientation;
  Pose pose{{message.position.x, message.position.y, message.position.z}, {q.w, q.x, q.y, q.z}};
  // Out of tolerance it stays as it is, and is refused by validate().
  if (std::abs(pose.orientation.norm() - 1) <= kNormTolerance) pose.orientation.normalize();
  return pose;
}

// 0 .. 6, from base to hand; none for a finger or a leg.
inline std::optional<int> arm_joint(const std::string& name) {
  if (name.size() != kArmJoints.size() + 1 || name.rfind(kArmJoints, 0) != 0) return std::nullopt;
  const int joint = name.back() - '1';
  return joint >= 0 && joint <= 6 ? std::optional(joint) : std::nullopt;
}

// The measured hand; none when a joint of the arm is missing or not finite.
inline std::optional<Pose> hand_of(const sensor_msgs::JointState& joints) {
  jaco_kinematics::JointVector q;
  int found = 0;
  for (std::size_t i = 0; i < std::min(joints.name.size(), joints.position.size()); ++i) {
    const auto joint = arm_joint(joints.name[i]);
    if (!joint) continue;
    q[*joint] = joints.position[i];
    ++found;
  }
  if (found != 7 || !q.allFinite()) return std::nullopt;
  const Eigen::Isometry3d hand = jaco_kinematics::forward(q);
  return Pose{hand.translation(), Eigen::Quaterniond(hand.linear()).normalized()};
}

inline void require_planning_frame(const std::string& frame_id) {
  if (frame_id != kPlanningFrame) {
    throw std::invalid_argument("frame_id is '" + frame_id + "', must be " + kPlanningFrame);
  }
}

inline TargetStatus to_target_status(std::uint8_t status) {
  using prf_msgs::TargetForecast;
  switch (status) {
    case TargetForecast::NO_TARGET:
      return TargetStatus::kNoTarget;
    case TargetForecast::TRACKING:
      return TargetStatus::kTracking;
    case TargetForecast::COASTING:
      return TargetStatus::kCoasting;
    case TargetForecast::LOST:
      return TargetStatus::kLost;
    default:
      throw std::invalid_argument("status is " + std::to_string(status) + ", must be 0 .. 3");
  }
}

inline std::shared_ptr<const Forecast> to_core(const prf_msgs::TargetForecast& message) {
  require_planning_frame(message.header.frame_id);
  auto forecast = std::make_shared<Forecast>();
  forecast->stamp = to_core(message.header.stamp);
  forecast->status = to_target_status(message.status);
  forecast->since_measurement = to_core(message.since_measurement);
  for (const auto& prediction : message.predictions) {
    forecast->predictions.push_back({to_core(prediction.horizon),
                                     {to_core(prediction.pose), to_core(prediction.twist.linear),
                                      to_core(prediction.twist.angular)}});
  }
  forecast->validate();
  return forecast;
}

inline std::shared_ptr<const Trajectory> to_core(const prf_msgs::SkillTrajectory& message) {
  require_planning_frame(message.header.frame_id);
  auto trajectory = std::make_shared<Trajectory>();
  for (const auto& pose : message.poses) trajectory->poses.push_back(to_core(pose));
  for (const auto& time : message.time_from_start) trajectory->times.push_back(to_core(time));
  trajectory->goal_in_target = to_core(message.goal_in_target);
  trajectory->validate();
  return trajectory;
}

inline prf_msgs::ExecutionProgress to_message(const Progress& progress) {
  prf_msgs::ExecutionProgress message;
  message.header.stamp = to_ros_time(progress.stamp);
  message.header.frame_id = kPlanningFrame;
  message.forecast_stamp = to_ros_time(progress.forecast_stamp);
  message.state = static_cast<std::uint8_t>(progress.state);
  message.reason = progress.reason;
  for (Eigen::Index i = 0; i < 3; ++i) {
    message.posterior[static_cast<std::size_t>(i)] = progress.posterior[i];
  }
  message.cursor = progress.cursor;
  message.frozen = static_cast<std::uint32_t>(progress.frozen);
  message.time_to_go = to_ros_duration(progress.time_to_go);
  message.demonstration = progress.demonstration.name;
  message.demonstration_switch = progress.demonstration.number;
  return message;
}
static_assert(static_cast<int>(State::kWaiting) == prf_msgs::ExecutionProgress::WAITING);
static_assert(static_cast<int>(State::kForward) == prf_msgs::ExecutionProgress::FORWARD);
static_assert(static_cast<int>(State::kPause) == prf_msgs::ExecutionProgress::PAUSE);
static_assert(static_cast<int>(State::kReverse) == prf_msgs::ExecutionProgress::REVERSE);
static_assert(static_cast<int>(State::kTracking) == prf_msgs::ExecutionProgress::TRACKING);
static_assert(static_cast<int>(State::kRetract) == prf_msgs::ExecutionProgress::RETRACT);
static_assert(static_cast<int>(State::kDone) == prf_msgs::ExecutionProgress::DONE);
static_assert(static_cast<int>(State::kStopped) == prf_msgs::ExecutionProgress::STOPPED);

inline void set(geometry_msgs::Vector3& to, const Eigen::Vector3d& from) {
  to.x = from.x();
  to.y = from.y();
  to.z = from.z();
}

inline trajectory_msgs::MultiDOFJointTrajectory to_message(
    Stamp stamp, const std::optional<MovingPose>& setpoint) {
  trajectory_msgs::MultiDOFJointTrajectory message;
  message.header.stamp = to_ros_time(stamp);
  message.header.frame_id = kPlanningFrame;
  message.joint_names = {kHandFrame};
  if (!setpoint) return message;

  geometry_msgs::Transform transform;
  set(transform.translation, setpoint->pose.position);
  const Eigen::Quaterniond& q = setpoint->pose.orientation;
  transform.rotation.w = q.w();
  transform.rotation.x = q.x();
  transform.rotation.y = q.y();
  transform.rotation.z = q.z();
  geometry_msgs::Twist twist;
  set(twist.linear, setpoint->linear_velocity);
  set(twist.angular, setpoint->angular_velocity);
  message.points.resize(1);
  message.points[0].transforms.push_back(transform);
  message.points[0].velocities.push_back(twist);
  return message;
}

}  // namespace prf_decision
