// SPDX-License-Identifier: BSD-3-Clause
#include "adapter_node.hpp"

#include <prf_msgs/topics.h>
#include <algorithm>
#include <limits>
#include <prf_core/quoted.hpp>
#include <prf_ros/conversions.hpp>

namespace prf_drivers {
namespace {

namespace topics = prf_msgs::topics;

constexpr std::uint32_t kQueue = 1000;  // messages

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return prf_core::quoted(text);
}

// Values of `joints` in their order; none: a joint is not named, or has no value.
std::optional<Eigen::VectorXd> picked(const std::vector<std::string>& joints,
                                      const std::vector<std::string>& names,
                                      const std::vector<double>& values) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(joints.size()));
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto found = std::find(names.begin(), names.end(), joints[i]);
    const auto index = static_cast<std::size_t>(found - names.begin());
    if (found == names.end() || index >= values.size()) return std::nullopt;
    result[static_cast<Eigen::Index>(i)] = values[index];
  }
  return result;
}

}  // namespace

AdapterNode::AdapterNode(ros::NodeHandle& node, const AdapterNodeParams& params)
    : params_(params),
      adapter_(params.adapter),
      output_(make_output(node, params)),
      inputs_(node, &diagnostics_),
      operator_(inputs_, params, [this] { adapter_.set_veto(operator_.veto()); }) {
  adapter_.set_veto(operator_.veto());
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
  take(adapter_.add_measured(*stamp, *measured));
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
    if (params_.pace == Pace::kTick) send(command);
  }
}

double AdapterNode::silent_for() const {
  if (ros::Time::isSimTime()) return (ros::Time::now() - decided_at_simulated_).toSec();
  return (ros::SteadyTime::now() - decided_at_).toSec();
}

void AdapterNode::on_period() {
  adapter_.set_veto(operator_.veto());  // a switch that is no longer heard
  operator_.tell(!newest_ ? -1 : hold_.empty() ? 0 : 2);
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
  hold_ = command.hold;
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
  } else {
    out.summary(Level::OK, "the arm follows");
  }
  inputs_.report(out);
  const AdapterCounts& counts = adapter_.counts();
  out.add("ticks", counts.ticks);
  out.add("messages to the driver", sent_);
  out.add("ticks held", counts.held);
  out.add("commands refused", counts.refused_commands);
  out.add("commands late or twice", counts.late_commands);
  out.add("new runs", counts.new_runs);
}

}  // namespace prf_drivers
