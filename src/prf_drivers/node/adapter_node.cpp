// SPDX-License-Identifier: BSD-3-Clause
#include "adapter_node.hpp"

#include <prf_msgs/topics.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <prf_core/quoted.hpp>
#include <prf_ros/conversions.hpp>

#include "picked.hpp"

namespace prf_drivers {
namespace {

namespace topics = prf_msgs::topics;

constexpr std::uint32_t kQueue = 1000;  // messages
// From the tick at which a speed is found to the first that has it: the others know it by then.
constexpr prf_core::Duration kAhead = std::chrono::milliseconds(50);
constexpr double kSteps = 20.0;  // a speed is announced in twentieths, rounded down

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return prf_core::quoted(text);
}

}  // namespace

AdapterNode::AdapterNode(ros::NodeHandle& node, const AdapterNodeParams& params)
    : params_(params),
      guards_(std::make_shared<MotionGuards>(params.guards)),
      adapter_(params.adapter, guards_),
      output_(make_output(node, params)),
      inputs_(node, &diagnostics_),
      operator_(
          inputs_, params, [this] { obey_operator(); }, [this] { guards_->reset(); }),
      speed_scale_(node.advertise<prf_msgs::SpeedScale>(topics::kSpeedScale, kQueue, true)) {
  for (const std::string& pair : guards_->ignored()) {
    ROS_INFO("%s are near each other in the ready posture: not looked at", pair.c_str());
  }
  obey_operator();
  diagnostics_.setHardwareID("none");
  diagnostics_.add("driver", this, &AdapterNode::diagnose);
  const double rate = 1.0 / params.driver.period;
  inputs_.subscribe<sensor_msgs::JointState>(
      {topics::kJointStates, "sensor_msgs/JointState with " + listed(params.driver.joints), rate},
      kQueue, [this](const sensor_msgs::JointStateConstPtr& message) { on_joints(*message); });
  inputs_.subscribe<trajectory_msgs::JointTrajectory>(
      {topics::kJointCommand,
       "trajectory_msgs/JointTrajectory with " + listed(params.driver.joints), rate},
      kQueue,
      [this](const trajectory_msgs::JointTrajectoryConstPtr& message) { on_command(*message); });
  inputs_.subscribe<prf_msgs::ExecutionProgress>(
      {topics::kExecutionProgress, "prf_msgs/ExecutionProgress", 0.0, prf_ros::Presence::kOnDemand},
      kQueue,
      [this](const prf_msgs::ExecutionProgressConstPtr& message) { on_progress(*message); });
  if (ros::Time::isSimTime()) {
    timer_ = node.createTimer(ros::Duration(params.driver.period),
                              [this](const ros::TimerEvent&) { on_period(); });
  } else {
    steady_timer_ = node.createSteadyTimer(ros::WallDuration(params.driver.period),
                                           [this](const ros::SteadyTimerEvent&) { on_period(); });
  }
}

void AdapterNode::on_joints(const sensor_msgs::JointState& message) {
  const auto stamp = prf_ros::usable_stamp(message.header.stamp);
  const auto measured = picked(params_.driver.joints, message.name, message.position);
  if (!stamp || !measured) {
    inputs_.drop(topics::kJointStates, stamp ? "without a joint of the arm" : "unusable stamp");
    return;
  }
  Measured joints(*measured);
  if (const auto effort = picked(params_.driver.joints, message.name, message.effort)) {
    joints.effort = *effort;
  }
  const std::size_t told = std::min(message.name.size(), message.position.size());
  for (std::size_t i = 0; i < told; ++i) {
    if (std::isfinite(message.position[i])) joints.elsewhere[message.name[i]] = message.position[i];
  }
  take(adapter_.add_measured(*stamp, joints));
}

void AdapterNode::on_progress(const prf_msgs::ExecutionProgress& message) {
  const auto stamp = prf_ros::usable_stamp(message.header.stamp);
  if (stamp && message.state == prf_msgs::ExecutionProgress::FORWARD) guards_->goes_forward(*stamp);
}

void AdapterNode::obey_operator() {
  adapter_.set_veto(operator_.veto());
  adapter_.set_speed(operator_.speed());
}

void AdapterNode::on_command(const trajectory_msgs::JointTrajectory& message) {
  const auto stamp = prf_ros::usable_stamp(message.header.stamp);
  if (!stamp) {
    inputs_.drop(topics::kJointCommand, "unusable stamp");
    return;
  }
  std::optional<Eigen::VectorXd> position, velocity;
  if (message.points.size() == 1) {
    const auto& point = message.points.front();
    position = picked(params_.driver.joints, message.joint_names, point.positions);
    velocity = picked(params_.driver.joints, message.joint_names, point.velocities);
  }
  if (position && velocity) {
    take(adapter_.add_command(*stamp, *position, *velocity));
  } else {
    const std::string why =
        "the command must have one point with position and velocity of each of " +
        listed(params_.driver.joints);
    inputs_.drop(topics::kJointCommand, why);
    take(adapter_.add_command(*stamp, {}, {}, why));
  }
}

void AdapterNode::take(const std::vector<DriverCommand>& decided) {
  for (const DriverCommand& command : decided) {
    newest_ = command;
    decided_at_ = ros::SteadyTime::now();
    decided_at_simulated_ = ros::Time::now();
    announce_speed(command);
    if (params_.pace == Pace::kTick) send(command);
  }
}

// While the arm is held the speed does not rise.
void AdapterNode::announce_speed(const DriverCommand& command) {
  if (!command.hold.empty() && announced_ && command.speed >= *announced_) return;
  const double scale = std::floor(kSteps * command.speed + 1e-9) / kSteps;
  const bool again = command.stamp < announced_at_;  // a new run
  announced_at_ = command.stamp;
  if (!again && announced_ == scale) return;
  announced_ = scale;
  prf_msgs::SpeedScale message;
  message.header.stamp = prf_ros::to_ros_time(command.stamp + kAhead);
  message.scale = scale;
  message.reason = command.slowed;
  speed_scale_.publish(message);
}

double AdapterNode::silent_for() const {
  if (ros::Time::isSimTime()) return (ros::Time::now() - decided_at_simulated_).toSec();
  return (ros::SteadyTime::now() - decided_at_).toSec();
}

void AdapterNode::on_period() {
  obey_operator();  // a switch may be heard no longer
  operator_.tell(code_);
  if (!newest_) return;
  if (silent_for() <= params_.adapter.command_timeout) {
    if (params_.pace == Pace::kTimer) send(*newest_);
  } else if (const auto held = adapter_.hold("no control tick any more")) {
    send(*held);
  }
}

void AdapterNode::send(const DriverCommand& command) {
  if (command.hold != hold_) {
    if (command.hold.empty()) {
      ROS_INFO("the arm follows again");
    } else if (told_.is_due(command.hold.substr(0, 20))) {
      ROS_WARN("the arm is held: %s", command.hold.c_str());
    }
  }
  if (!command.slowed.empty() && slowed_.empty() && command.hold.empty() &&
      told_.is_due("slowed")) {
    ROS_WARN("the arm goes at %.0f %% of its speed: %s", 100.0 * command.speed,
             command.slowed.c_str());
  }
  hold_ = command.hold;
  slowed_ = command.slowed;
  code_ = command.code;
  operator_.tell(code_);
  output_->send(command);
  ++sent_;
}

void AdapterNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& out) {
  using Level = diagnostic_msgs::DiagnosticStatus;
  if (output_->subscribers() == 0) {
    out.summary(Level::ERROR,
                "no driver takes " + params_.driver.command_topic + ", is it started?");
  } else if (!newest_) {
    out.summary(Level::WARN, "no command so far");
  } else if (!hold_.empty()) {
    out.summary(Level::WARN, "the arm is held: " + hold_);
  } else if (!slowed_.empty()) {
    out.summary(Level::OK, "the arm follows slowly: " + slowed_);
  } else {
    out.summary(Level::OK, "the arm follows");
  }
  inputs_.report(out);
  const AdapterCounts& counts = adapter_.counts();
  out.add("speed [%]", 100.0 * announced_.value_or(1.0));
  out.add("ticks", counts.ticks);
  out.add("messages to the driver", sent_);
  out.add("ticks held", counts.held);
  out.add("commands refused", counts.refused_commands);
  out.add("commands late or twice", counts.late_commands);
  out.add("new runs", counts.new_runs);
}

}  // namespace prf_drivers
