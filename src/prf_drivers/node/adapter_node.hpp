// SPDX-License-Identifier: BSD-3-Clause
// The node driver_adapter: joint_states + joint_command -> what the arm's driver takes.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/ExecutionProgress.h>
#include <prf_msgs/SpeedScale.h>
#include <ros/ros.h>
#include <ros/steady_timer.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <memory>
#include <optional>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/wall_throttle.hpp>
#include <string>
#include <vector>

#include "driver_output.hpp"
#include "operator_services.hpp"
#include "params.hpp"

namespace prf_drivers {

class AdapterNode {
 public:
  AdapterNode(ros::NodeHandle& node, const AdapterNodeParams& params);

 private:
  void on_joints(const sensor_msgs::JointState& message);
  void on_command(const trajectory_msgs::JointTrajectory& message);
  void on_progress(const prf_msgs::ExecutionProgress& message);
  void obey_operator();
  void take(const std::vector<DriverCommand>& decided);
  void send(const DriverCommand& command);
  // To controller and decision, whenever the allowed speed changes.
  void announce_speed(const DriverCommand& command);
  // Each period: the newest command in the pace of a timer; braking and holding when ticks stay
  // out.
  void on_period();
  // s since the last tick was decided; in simulated time while that is in use, so that a simulator
  // that waits is not taken for silence.
  [[nodiscard]] double silent_for() const;
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& out);

  AdapterNodeParams params_;
  std::shared_ptr<MotionGuards> guards_;
  CommandAdapter adapter_;
  std::unique_ptr<DriverOutput> output_;
  diagnostic_updater::Updater diagnostics_;
  prf_ros::InputMonitor inputs_;
  OperatorServices operator_;
  ros::SteadyTimer steady_timer_;
  ros::Timer timer_;
  std::optional<DriverCommand> newest_;
  ros::SteadyTime decided_at_;
  ros::Time decided_at_simulated_;
  ros::Publisher speed_scale_;
  std::optional<double> announced_;
  prf_core::Stamp announced_at_{0};
  std::string hold_, slowed_;
  MotionCode code_ = MotionCode::kNoCommand;
  unsigned long sent_ = 0;
  prf_ros::WallThrottles told_;
};

}  // namespace prf_drivers
