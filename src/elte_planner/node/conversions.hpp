// SPDX-License-Identifier: BSD-3-Clause
// Messages of skill_planner_node to the types of its core and back.
#pragma once

#include <prf_msgs/ExecutionProgress.h>
#include <prf_msgs/SkillTrajectory.h>
#include <prf_msgs/TargetForecast.h>
#include <visualization_msgs/MarkerArray.h>

#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <prf_ros/conversions.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "elte_planner/current_skill.hpp"

namespace elte_planner {

inline void require_frame(const std::string& frame_id, const std::string& planning_frame) {
  prf_core::require(frame_id == planning_frame, "frame_id", prf_core::quoted(frame_id),
                    prf_core::quoted(planning_frame));
}

// The forecast and, when it is refused, the reason; then the target counts as lost. Throws
// std::invalid_argument when not even the stamp can be used.
inline std::pair<prf_core::TargetForecast, std::string> forecast_from(
    const prf_msgs::TargetForecast& message) {
  try {
    return {prf_ros::to_core(message), ""};
  } catch (const std::invalid_argument& refusal) {
    prf_core::TargetForecast lost;
    lost.stamp = prf_ros::checked_stamp("stamp", message.header.stamp);
    lost.status = prf_core::TargetStatus::kLost;
    return {lost, refusal.what()};
  }
}

// Throws std::invalid_argument for stamps that cannot be used.
inline Progress progress_from(const prf_msgs::ExecutionProgress& message) {
  return {prf_ros::checked_stamp("stamp", message.header.stamp),
          prf_ros::checked_stamp("forecast_stamp", message.forecast_stamp),
          static_cast<Eigen::Index>(message.frozen),
          prf_ros::to_core(message.time_to_go),
          {message.demonstration, message.demonstration_switch}};
}

// A SPHERE with one diameter as its scale, or a CUBE. Throws std::invalid_argument for others.
inline PlacedObstacle obstacle_from(const visualization_msgs::Marker& marker) {
  using visualization_msgs::Marker;
  const prf_core::Pose pose = prf_ros::to_core(marker.pose);
  prf_core::require_pose("obstacle", pose);
  const Eigen::Vector3d size = prf_ros::to_core(marker.scale);
  for (const double length : size)
    prf_core::require_between("obstacle's scale", length, 0.0, 20.0, "m");
  const bool is_ball =
      marker.type == Marker::SPHERE && size.x() == size.y() && size.x() == size.z();
  prf_core::require(is_ball || marker.type == Marker::CUBE, "obstacle's type",
                    static_cast<int>(marker.type), "SPHERE with three equal scales, or CUBE");
  if (is_ball) return {Obstacle::disc(pose.position, 0.5 * size.x())};
  return {Obstacle::box(pose.position, 0.5 * size, pose.orientation.toRotationMatrix())};
}

// The stamp of the message's first marker (0 without any) and all its obstacles. Markers whose
// action is not ADD are none. Throws std::invalid_argument for a message that cannot be used.
inline std::pair<prf_core::Stamp, std::vector<PlacedObstacle>> obstacles_from(
    const visualization_msgs::MarkerArray& message, const std::string& planning_frame,
    const std::string& target_frame) {
  std::pair<prf_core::Stamp, std::vector<PlacedObstacle>> result;
  if (message.markers.empty()) return result;
  result.first = prf_ros::checked_stamp("stamp", message.markers.front().header.stamp);
  for (const visualization_msgs::Marker& marker : message.markers) {
    if (marker.action != visualization_msgs::Marker::ADD) continue;
    const std::string& frame = marker.header.frame_id;
    prf_core::require(frame == planning_frame || frame == target_frame, "frame_id",
                      prf_core::quoted(frame),
                      prf_core::quoted(planning_frame) + " or " + prf_core::quoted(target_frame));
    result.second.push_back(obstacle_from(marker));
    result.second.back().on_target = frame == target_frame;
  }
  prf_core::require(result.second.size() <= kMostObstacles, "obstacles", result.second.size(),
                    "at most " + std::to_string(kMostObstacles));
  return result;
}

inline std::uint8_t to_message(SkillStatus status) {
  switch (status) {
    case SkillStatus::kSolved:
      return prf_msgs::SkillTrajectory::SOLVED;
    case SkillStatus::kRelaxed:
      return prf_msgs::SkillTrajectory::RELAXED;
    case SkillStatus::kKept:
      return prf_msgs::SkillTrajectory::KEPT;
    case SkillStatus::kBlocked:  // its poses are not sent, so the execution pauses
    case SkillStatus::kNoPlan:
      break;
  }
  return prf_msgs::SkillTrajectory::NO_PLAN;
}

// Everything but the plan.
inline prf_msgs::SkillTrajectory header_for(const Progress& progress, const CurrentSkill& skill) {
  prf_msgs::SkillTrajectory message;
  message.header.stamp = prf_ros::to_ros_time(progress.stamp);
  message.header.frame_id = skill.session().demonstration().frame();
  message.forecast_stamp = prf_ros::to_ros_time(progress.forecast_stamp);
  message.demonstration = skill.demonstration();
  message.demonstration_switch = progress.demonstration.demonstration_switch;
  message.planner = skill.session().planner_name();
  message.goal_in_target = prf_ros::to_message(skill.session().goal_in_target());
  return message;
}

inline prf_msgs::SkillTrajectory refusal_for(const Progress& progress, const CurrentSkill& skill,
                                             const std::string& reason) {
  prf_msgs::SkillTrajectory message = header_for(progress, skill);
  message.status = prf_msgs::SkillTrajectory::REFUSED;
  message.message = reason;
  return message;
}

inline prf_msgs::SkillTrajectory trajectory_for(const Progress& progress, const CurrentSkill& skill,
                                                const SkillResult& result) {
  prf_msgs::SkillTrajectory message = header_for(progress, skill);
  message.status = to_message(result.status);
  message.message = result.message;
  message.frozen = static_cast<std::uint32_t>(result.frozen);
  message.kkt_residual = result.kkt_residual;
  message.radius = result.radius;
  message.slack = result.slack;
  if (message.status == prf_msgs::SkillTrajectory::NO_PLAN) return message;
  for (const TimedPose& node : result.poses) {
    message.poses.push_back(prf_ros::to_message(node.pose));
    message.time_from_start.emplace_back(node.time);
  }
  return message;
}

}  // namespace elte_planner
