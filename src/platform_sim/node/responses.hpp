// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/WrenchStamped.h>
#include <prf_msgs/ExecutionProgress.h>
#include <prf_msgs/SkillTrajectory.h>
#include <prf_msgs/TagDetectionArray.h>
#include <prf_msgs/TargetForecast.h>
#include <ros/node_handle.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <trajectory_msgs/MultiDOFJointTrajectory.h>

#include <optional>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/wall_throttle.hpp>
#include <string>
#include <vector>

#include "conversions.hpp"
#include "platform_sim/lockstep.hpp"

namespace platform_sim {

// What comes back from the framework, or from the guiding hand.
class Responses {
 public:
  // `with_driver`: joint_command is only noted, the arm is moved by what its driver is sent.
  // `joints` of the arm.
  Responses(ros::NodeHandle& node, Peer peer, bool with_driver,
            const std::vector<std::string>& joints);

  Lockstep& lockstep() { return lockstep_; }

  // The command or wrench received last, each handed out once; none if it was refused.
  std::optional<ArmCommand> take_command();
  std::optional<HandWrench> take_wrench();

  // True from the first execution/progress that is DONE or STOPPED.
  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] unsigned refused() const { return refused_; }

  // Names of the topics that nobody publishes.
  [[nodiscard]] std::vector<std::string> without_publisher() const;
  [[nodiscard]] unsigned publishers() const;

 private:
  template <class Message>
  void listen(Response response, const std::string& what,
              void (Responses::*receive)(const Message&));
  template <class Message>
  void note(Response response, const std::string& what);
  void receive_progress(const prf_msgs::ExecutionProgress& message);
  void receive_command(const trajectory_msgs::JointTrajectory& message);
  void receive_wrench(const geometry_msgs::WrenchStamped& message);
  // Whether the lockstep takes a message of this stamp; it is dropped otherwise.
  bool take(Response response, const ros::Time& stamp, const ros::Time& forecast_stamp = {});
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  void refuse(Response response, const std::string& why);

  std::vector<std::string> joints_;
  Lockstep lockstep_;
  std::optional<ArmCommand> command_;
  std::optional<HandWrench> wrench_;
  bool finished_ = false;
  unsigned refused_ = 0;
  prf_ros::WallThrottle refusals_;
  diagnostic_updater::Updater updater_;
  prf_ros::InputMonitor inputs_;
};

}  // namespace platform_sim
