// SPDX-License-Identifier: BSD-3-Clause
// The node driver_adapter: joint_states + joint_command -> what the arm's driver takes.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
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
  void take(const std::vector<DriverCommand>& decided);
  void send(const DriverCommand& command);
  // Each period: the newest command in the pace of a timer; braking and holding when ticks stay
  // out.
  void on_period();
  // s since the last tick was decided; in simulated time while that is in use, so that a simulator
  // that waits is not taken for silence.
  [[nodiscard]] double silent_for() const;
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& out);

  AdapterNodeParams params_;
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
  std::string hold_;
  unsigned long sent_ = 0;
  prf_ros::WallThrottles told_;
};

}  // namespace prf_drivers
