// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Pose.h>
#include <prf_msgs/ExecutionProgress.h>
#include <prf_msgs/SkillTrajectory.h>
#include <prf_msgs/TargetForecast.h>

#include "elte_planner/followed_skill.hpp"

namespace elte_planner {

inline std::int64_t nanoseconds(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
}

inline ros::Time ros_time(std::int64_t nanoseconds) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(nanoseconds));
}

inline Pose pose_from(const geometry_msgs::Pose& message) {
  return {
      {message.position.x, message.position.y, message.position.z},
      {message.orientation.w, message.orientation.x, message.orientation.y, message.orientation.z}};
}

inline geometry_msgs::Pose message_from(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.position.x();
  message.position.y = pose.position.y();
  message.position.z = pose.position.z();
  message.orientation.x = pose.orientation.x();
  message.orientation.y = pose.orientation.y();
  message.orientation.z = pose.orientation.z();
  message.orientation.w = pose.orientation.w();
  return message;
}

inline TargetStatus target_status(std::uint8_t status) {
  switch (status) {
    case prf_msgs::TargetForecast::TRACKING:
      return TargetStatus::kTracking;
    case prf_msgs::TargetForecast::COASTING:
      return TargetStatus::kCoasting;
    case prf_msgs::TargetForecast::LOST:
      return TargetStatus::kLost;
    default:
      return TargetStatus::kNoTarget;
  }
}

inline Forecast forecast_from(const prf_msgs::TargetForecast& message) {
  Forecast forecast{nanoseconds(message.header.stamp), target_status(message.status), {}};
  for (const auto& prediction : message.predictions) {
    // Upper left 3x3 of the row-major 6x6 over (position, velocity).
    const Eigen::Map<const Eigen::Matrix3d, 0, Eigen::OuterStride<6>> covariance(
        prediction.covariance.data());
    forecast.predictions.push_back(
        {prediction.horizon.toSec(),
         pose_from(prediction.pose),
         covariance.transpose(),
         {prediction.twist.linear.x, prediction.twist.linear.y, prediction.twist.linear.z}});
  }
  return forecast;
}

inline Progress progress_from(const prf_msgs::ExecutionProgress& message) {
  return {nanoseconds(message.header.stamp),
          nanoseconds(message.forecast_stamp),
          static_cast<Eigen::Index>(message.frozen),
          message.time_to_go.toSec(),
          {message.demonstration, message.demonstration_switch}};
}

inline std::uint8_t message_status(AnswerStatus status) {
  switch (status) {
    case AnswerStatus::kSolved:
      return prf_msgs::SkillTrajectory::SOLVED;
    case AnswerStatus::kRelaxed:
      return prf_msgs::SkillTrajectory::RELAXED;
    case AnswerStatus::kKept:
      return prf_msgs::SkillTrajectory::KEPT;
    case AnswerStatus::kNoPlan:
      break;
  }
  return prf_msgs::SkillTrajectory::NO_PLAN;
}

inline prf_msgs::SkillTrajectory answer_to(const Progress& progress, const FollowedSkill& skill) {
  prf_msgs::SkillTrajectory message;
  message.header.stamp = ros_time(progress.stamp);
  message.header.frame_id = skill.session().demonstration().frame();
  message.forecast_stamp = ros_time(progress.forecast_stamp);
  message.demonstration = skill.demonstration();
  message.demonstration_switch = progress.wanted.demonstration_switch;
  message.planner = skill.session().planner_name();
  message.goal_in_target = message_from(skill.session().goal_in_target());
  return message;
}

inline prf_msgs::SkillTrajectory refusal_from(const Progress& progress, const FollowedSkill& skill,
                                              const std::string& reason) {
  prf_msgs::SkillTrajectory message = answer_to(progress, skill);
  message.status = prf_msgs::SkillTrajectory::REFUSED;
  message.message = reason;
  return message;
}

inline prf_msgs::SkillTrajectory trajectory_from(const Progress& progress,
                                                 const FollowedSkill& skill,
                                                 const SkillAnswer& answer) {
  prf_msgs::SkillTrajectory message = answer_to(progress, skill);
  message.status = message_status(answer.status);
  message.message = answer.message;
  message.frozen = static_cast<std::uint32_t>(answer.frozen);
  message.kkt_residual = answer.kkt_residual;
  message.radius = answer.radius;
  message.slack = answer.slack;
  for (const TimedPose& node : answer.poses) {
    message.poses.push_back(message_from(node.pose));
    message.time_from_start.emplace_back(node.time);
  }
  return message;
}

}  // namespace elte_planner
