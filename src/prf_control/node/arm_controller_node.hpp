// SPDX-License-Identifier: BSD-3-Clause
// The node arm_controller: joint_states + execution/setpoint -> joint_command + control/status, one
// of each per tick.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/SpeedScale.h>
#include <ros/ros.h>

#include <chrono>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/reconfigurable.hpp>
#include <prf_ros/wall_throttle.hpp>
#include <string>
#include <vector>

#include "messages.hpp"
#include "params.hpp"

namespace prf_control {

class ArmControllerNode {
 public:
  ArmControllerNode(ros::NodeHandle& node, const NodeParams& params);

 private:
  using Clock = std::chrono::steady_clock;

  void on_joints(const sensor_msgs::JointState& message);
  void on_setpoint(const trajectory_msgs::MultiDOFJointTrajectory& message);
  void on_speed(const prf_msgs::SpeedScale& message);
  void ignore(const sensor_msgs::JointState& message, const std::string& refusal);
  void publish(const std::vector<ControlResult>& results, Clock::time_point begin);
  void note_drop(const char* topic, const JoinerCounts& before);
  void log(const ControlResult& result);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& out);
  void summarise(diagnostic_updater::DiagnosticStatusWrapper& out);

  NodeParams params_;
  std::vector<std::string> joint_names_;
  ArmController controller_;
  prf_ros::ReconfigurableParams reconfigurable_;
  ros::Publisher command_, status_;
  diagnostic_updater::Updater diagnostics_;
  prf_ros::InputMonitor inputs_;
  ControlResult last_;
  prf_ros::WallThrottles told_;
  std::uint64_t armless_in_a_row_ = 0;  // messages
  double longest_tick_ = 0.0;           // [s]
};

}  // namespace prf_control
