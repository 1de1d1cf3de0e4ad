// SPDX-License-Identifier: BSD-3-Clause
// joint_states + execution/setpoint -> joint_command + control/status, one of each per tick.
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <prf_ros/conversions.hpp>
#include <prf_ros/private_parameters.hpp>
#include <prf_ros/reconfigurable.hpp>

#include "messages.hpp"
#include "params.hpp"
#include "robot_description.hpp"

namespace prf_control {
namespace {

constexpr double kWarnPeriod = 1.0;     // [s]
constexpr std::uint32_t kQueue = 1000;  // messages, 10 s of ticks
constexpr double kDescriptionPatience =
    5.0;  // [s], wall clock: the launch file's other nodes start

class ArmControllerNode {
 public:
  ArmControllerNode(ros::NodeHandle& node, const NodeParams& params)
      : params_(params),
        joint_names_(params.joint_names()),
        controller_(params.controller),
        reconfigurable_(ros::NodeHandle("~"),
                        {{"velocity_scale", params.controller.follower.velocity_scale,
                          "share of the URDF's joint velocity limits"},
                         {"acceleration", params.controller.follower.acceleration,
                          "limit of every joint, rad/s^2"}},
                        [this](const prf_ros::ReconfigurableParams::Values& values) {
                          controller_.tune(values.at("velocity_scale"), values.at("acceleration"));
                        }) {
    diagnostics_.setHardwareID("none");
    diagnostics_.add("control", this, &ArmControllerNode::diagnose);
    const auto hints = ros::TransportHints().tcpNoDelay();
    joints_ = node.subscribe("joint_states", kQueue, &ArmControllerNode::on_joints, this, hints);
    setpoint_ =
        node.subscribe("execution/setpoint", kQueue, &ArmControllerNode::on_setpoint, this, hints);
    // After subscribing: a node that sees this publisher may start, and nothing is missed.
    status_ = node.advertise<prf_msgs::ControlStatus>("control/status", kQueue);
    command_ = node.advertise<trajectory_msgs::JointTrajectory>("joint_command", kQueue);
  }

 private:
  void on_joints(const sensor_msgs::JointState& message) {
    const auto sample = to_sample(message, joint_names_);
    if (!sample) {
      ++incomplete_joint_states_;
      ROS_WARN_THROTTLE(kWarnPeriod, "joint_states without all joints of the arm: ignored");
      return;
    }
    const auto begin = std::chrono::steady_clock::now();
    publish(controller_.add_joints(*sample), begin);
  }

  void on_setpoint(const trajectory_msgs::MultiDOFJointTrajectory& message) {
    const auto begin = std::chrono::steady_clock::now();
    publish(controller_.add_setpoint(prf_ros::to_core(message.header.stamp),
                                     to_setpoint(message, params_)),
            begin);
  }

  void publish(const std::vector<ControlResult>& results,
               std::chrono::steady_clock::time_point begin) {
    for (const ControlResult& result : results) {
      if (result.command) command_.publish(command_message(result, joint_names_));
      status_.publish(status_message(result));
      log(result);
      last_ = result;
    }
    if (!results.empty()) {
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
      longest_tick_ = std::max(longest_tick_, spent.count());
    }
    diagnostics_.update();
  }

  void log(const ControlResult& result) {
    const bool first_of_its_kind = result.code != last_.code || result.restarted;
    if (result.reason.empty() || !first_of_its_kind) return;
    if (result.restarted) {
      ROS_WARN("%s", result.reason.c_str());
    } else {
      ROS_WARN_THROTTLE(kWarnPeriod, "%s", result.reason.c_str());
    }
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& out) {
    const bool fine = last_.code <= ControlCode::kLimited;
    out.summary(
        fine ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
        last_.reason.empty() ? "fine" : last_.reason);
    const ControllerCounts& counts = controller_.counts();
    const JoinerCounts& joiner = controller_.joiner_counts();
    out.add("ticks", counts.ticks);
    out.add("ticks without set-point", joiner.missing_setpoints);
    out.add("times that the set-points fell silent", joiner.silences);
    out.add("set-points late", joiner.late_setpoints);
    out.add("set-points far ahead", joiner.far_ahead_setpoints);
    out.add("set-points invalid", counts.invalid_setpoints);
    out.add("joint_states incomplete", incomplete_joint_states_);
    out.add("joint_states not finite", counts.faulty_joints);
    out.add("joint_states of a stamp seen before", joiner.duplicate_ticks);
    out.add("joint_states old", joiner.old_ticks);
    out.add("joint_states far ahead", joiner.far_ahead_ticks);
    out.add("jumps of a joint goal refused", counts.refused_jumps);
    out.add("ticks of a branch change", counts.branch_changing);
    out.add("starts from measured joints", counts.restarts);
    out.add("new runs", joiner.new_runs);
    out.add("longest computation of a tick [ms]", 1e3 * longest_tick_);
  }

  NodeParams params_;
  std::vector<std::string> joint_names_;
  ArmController controller_;
  prf_ros::ReconfigurableParams reconfigurable_;
  ros::Publisher command_, status_;
  ros::Subscriber joints_, setpoint_;
  diagnostic_updater::Updater diagnostics_;
  ControlResult last_;
  std::uint64_t incomplete_joint_states_ = 0;
  double longest_tick_ = 0.0;
};

}  // namespace
}  // namespace prf_control

int main(int argc, char** argv) {
  ros::init(argc, argv, "arm_controller");
  ros::NodeHandle node;
  return prf_ros::run([&node] {
    const prf_control::NodeParams params = prf_control::load_params(ros::NodeHandle("~"));
    prf_control::require_same_arm(
        prf_control::wait_for_robot_description(node, prf_control::kDescriptionPatience),
        {params.joint_names(), params.planning_frame, params.hand_frame});
    prf_control::ArmControllerNode controller(node, params);
    ros::spin();
  });
}
