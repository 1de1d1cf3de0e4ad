// SPDX-License-Identifier: BSD-3-Clause
// The node around CurrentSkill: messages in, one plan for each request, diagnostics.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/ExecutionProgress.h>
#include <prf_msgs/SkillTrajectory.h>
#include <prf_msgs/TargetForecast.h>
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <boost/circular_buffer.hpp>
#include <chrono>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/wall_throttle.hpp>
#include <string>

#include "elte_planner/current_skill.hpp"
#include "elte_planner/obstacle_history.hpp"
#include "elte_planner/request_queue.hpp"
#include "params.hpp"

namespace elte_planner {

class SkillPlannerNode {
 public:
  explicit SkillPlannerNode(const SkillPlannerParams& params);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void warn_of_lost_shape() const;
  void on_forecast(const prf_msgs::TargetForecast& message);
  void on_progress(const prf_msgs::ExecutionProgress& message);
  void on_obstacles(const visualization_msgs::MarkerArray& message);
  // Throw std::invalid_argument for a message that is to be dropped.
  void take(const prf_msgs::TargetForecast& message);
  void take(const prf_msgs::ExecutionProgress& message);
  void plan_decided_requests();
  prf_msgs::SkillTrajectory plan(const JoinedRequest& request);
  void note_solve_time(std::chrono::duration<double> time);
  bool is_late() const { return solve_time_.count() > params_.late_after; }
  void diagnose(Status& status);

  SkillPlannerParams params_;
  CurrentSkill skill_;
  RequestQueue queue_;
  ObstacleHistory obstacles_;  // of the topic

  prf_ros::WallThrottles told_;
  std::size_t requests_ = 0, kept_ = 0, blocked_ = 0, late_ = 0, refused_ = 0;
  std::size_t refusals_reported_ = 0;  // of forecasts, by the last diagnostics
  SkillStatus status_ = SkillStatus::kNoPlan;
  std::string message_;  // of the last plan
  std::chrono::duration<double> solve_time_{0.0}, longest_solve_{0.0};
  boost::circular_buffer<double> solve_times_{10000};  // us, the latest

  ros::NodeHandle node_;
  ros::Publisher trajectory_;
  diagnostic_updater::Updater updater_;
  prf_ros::InputMonitor inputs_{node_, &updater_};
};

}  // namespace elte_planner
