// SPDX-License-Identifier: BSD-3-Clause
#include "arm_controller_node.hpp"

#include <algorithm>
#include <prf_core/require.hpp>
#include <prf_ros/conversions.hpp>

namespace prf_control {
namespace {

constexpr const char* kJointStates = "joint_states";
constexpr const char* kSetpoint = "execution/setpoint";
constexpr const char* kSpeedScale = "speed_scale";
constexpr std::uint64_t kArmless = 100;  // messages: other parts of the robot may publish, too
constexpr std::uint32_t kQueue = 1000;   // messages, 10 s of ticks

// What was lost between two counts; empty: nothing.
std::string drop_between(const JoinerCounts& before, const JoinerCounts& after) {
  if (after.duplicate_ticks > before.duplicate_ticks) return "a tick of this stamp has come before";
  if (after.old_ticks > before.old_ticks) return "older than the newest tick";
  if (after.late_setpoints > before.late_setpoints) {
    return "its tick is decided, or one of this stamp has come before";
  }
  if (after.far_ahead_ticks > before.far_ahead_ticks ||
      after.far_ahead_setpoints > before.far_ahead_setpoints) {
    return "far ahead of the newest tick";
  }
  return "";
}

bool is_outside(const ControlResult& result, const JointLimits& limits) {
  return result.command && joints_outside(result.command->position, limits).maxCoeff() > 1e-9;
}

}  // namespace

ArmControllerNode::ArmControllerNode(ros::NodeHandle& node, const NodeParams& params)
    : params_(params),
      joint_names_(params.robot.joints),
      controller_(params.robot.kinematics, params.controller),
      reconfigurable_(ros::NodeHandle("~"),
                      {{"velocity_scale", params.controller.follower.velocity_scale,
                        "share of the URDF's joint velocity limits"},
                       {"acceleration", params.controller.follower.acceleration,
                        "limit of every joint, rad/s^2"}},
                      [this](const prf_ros::ReconfigurableParams::Values& values) {
                        controller_.tune(values.at("velocity_scale"), values.at("acceleration"));
                      }),
      inputs_(node, &diagnostics_) {
  diagnostics_.setHardwareID("none");
  diagnostics_.add("control", this, &ArmControllerNode::diagnose);
  inputs_.subscribe<sensor_msgs::JointState>(
      {kJointStates, "sensor_msgs/JointState with " + listed(joint_names_),
       1.0 / params.tick_period},
      kQueue, [this](const sensor_msgs::JointStateConstPtr& message) { on_joints(*message); });
  inputs_.subscribe<trajectory_msgs::MultiDOFJointTrajectory>(
      {kSetpoint,
       "trajectory_msgs/MultiDOFJointTrajectory with the stamp of each joint_states, " +
           params.robot.tip_link + " in " + params.robot.base_link,
       1.0 / params.tick_period},
      kQueue, [this](const trajectory_msgs::MultiDOFJointTrajectoryConstPtr& message) {
        on_setpoint(*message);
      });
  inputs_.subscribe<prf_msgs::SpeedScale>(
      {kSpeedScale, "prf_msgs/SpeedScale, 0 to 1", 0.0, prf_ros::Presence::kOnDemand}, kQueue,
      [this](const prf_msgs::SpeedScaleConstPtr& message) { on_speed(*message); });
  // After subscribing: a node that sees this publisher may start, and nothing is missed.
  status_ = node.advertise<prf_msgs::ControlStatus>("control/status", kQueue);
  command_ = node.advertise<trajectory_msgs::JointTrajectory>("joint_command", kQueue);
}

void ArmControllerNode::on_joints(const sensor_msgs::JointState& message) {
  const JointReading reading = to_sample(message, joint_names_);
  if (!reading.sample) {
    ignore(message, reading.refusal);
    return;
  }
  armless_in_a_row_ = 0;
  const auto begin = Clock::now();
  const JoinerCounts before = controller_.joiner_counts();
  publish(controller_.add_joints(*reading.sample), begin);
  note_drop(kJointStates, before);
}

void ArmControllerNode::ignore(const sensor_msgs::JointState& message, const std::string& refusal) {
  if (!refusal.empty()) {
    inputs_.drop(kJointStates, "stamp or joints cannot be used");
    if (told_.is_due("unusable joint_states")) {
      ROS_WARN("joint_states: %s: dropped", refusal.c_str());
    }
  } else if (++armless_in_a_row_ >= kArmless) {
    inputs_.drop(kJointStates, "no joint of the arm in it");
    if (told_.is_due("other joints")) {
      ROS_WARN("joint_states: expected the joints %s, received %s", listed(joint_names_).c_str(),
               listed(message.name).c_str());
    }
  }
}

void ArmControllerNode::on_setpoint(const trajectory_msgs::MultiDOFJointTrajectory& message) {
  const auto stamp = prf_ros::usable_stamp(message.header.stamp);
  if (!stamp) {
    inputs_.drop(kSetpoint, "stamp beyond the bounds of time");
    return;
  }
  const auto begin = Clock::now();
  const JoinerCounts before = controller_.joiner_counts();
  publish(controller_.add_setpoint(*stamp, to_setpoint(message, params_)), begin);
  note_drop(kSetpoint, before);
}

void ArmControllerNode::on_speed(const prf_msgs::SpeedScale& message) {
  const auto stamp = prf_ros::usable_stamp(message.header.stamp);
  try {
    prf_core::require(stamp.has_value(), "stamp", message.header.stamp.toSec(), "a time");
    controller_.scale_speed(*stamp, message.scale);
  } catch (const std::invalid_argument& error) {
    inputs_.drop(kSpeedScale, error.what());
  }
}

void ArmControllerNode::note_drop(const char* topic, const JoinerCounts& before) {
  const std::string reason = drop_between(before, controller_.joiner_counts());
  if (!reason.empty()) inputs_.drop(topic, reason);
}

void ArmControllerNode::publish(const std::vector<ControlResult>& results,
                                Clock::time_point begin) {
  for (const ControlResult& result : results) {
    if (result.command) command_.publish(command_message(result, params_));
    status_.publish(status_message(result));
    log(result);
    last_ = result;
  }
  if (!results.empty()) {
    const std::chrono::duration<double> spent = Clock::now() - begin;
    longest_tick_ = std::max(longest_tick_, spent.count());
  }
  diagnostics_.update();
}

void ArmControllerNode::log(const ControlResult& result) {
  if (result.reason.empty()) return;
  const bool is_new = result.code != last_.code || result.restarted;
  if (result.restarted && result.code == ControlCode::kHolding) {
    ROS_WARN("%s", result.reason.c_str());
    return;
  }
  if (!is_new && result.code <= ControlCode::kLimited) return;
  if (!told_.is_due("code " + std::to_string(static_cast<int>(result.code)))) return;
  if (result.code == ControlCode::kFailing) {
    ROS_ERROR("%s", result.reason.c_str());
  } else {
    ROS_WARN("%s", result.reason.c_str());
  }
}

void ArmControllerNode::summarise(diagnostic_updater::DiagnosticStatusWrapper& out) {
  using Level = diagnostic_msgs::DiagnosticStatus;
  if (controller_.counts().ticks == 0) {
    out.summary(Level::ERROR,
                "no control tick: no joint_states with all of " + listed(joint_names_));
  } else if (last_.code == ControlCode::kFailing) {
    out.summary(Level::ERROR, last_.reason);
  } else if (last_.code > ControlCode::kLimited ||
             is_outside(last_, params_.robot.kinematics->limits())) {
    out.summary(Level::WARN, last_.reason);
  } else {
    out.summary(Level::OK, last_.reason.empty() ? "fine" : last_.reason);
  }
}

void ArmControllerNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& out) {
  summarise(out);
  inputs_.report(out);
  const ControllerCounts& counts = controller_.counts();
  const JoinerCounts& joiner = controller_.joiner_counts();
  out.add("ticks", counts.ticks);
  out.add("ticks without set-point", joiner.missing_setpoints);
  out.add("times that the set-points fell silent", joiner.silences);
  out.add("set-points late or twice", joiner.late_setpoints);
  out.add("set-points far ahead", joiner.far_ahead_setpoints);
  out.add("set-points invalid", counts.invalid_setpoints);
  out.add("joint_states not usable", counts.faulty_joints);
  out.add("commands refused by the gate", counts.refused_commands);
  out.add("ticks with a joint reported in another turn", counts.other_turns);
  out.add("joint_states of a stamp seen before", joiner.duplicate_ticks);
  out.add("joint_states old", joiner.old_ticks);
  out.add("joint_states far ahead", joiner.far_ahead_ticks);
  out.add("jumps of a joint goal refused", counts.refused_jumps);
  out.add("ticks of a branch change", counts.branch_changing);
  out.add("starts from measured joints", counts.restarts);
  out.add("new runs", joiner.new_runs);
  out.add("longest computation of a tick [ms]", 1e3 * longest_tick_);
}

}  // namespace prf_control
