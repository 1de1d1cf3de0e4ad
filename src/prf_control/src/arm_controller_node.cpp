// SPDX-License-Identifier: BSD-3-Clause
// joint_states + execution/setpoint -> joint_command + control/status, one of each per tick.
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <chrono>
#include <prf_ros/reconfigurable.hpp>

#include "conversions.hpp"

namespace prf_control {
namespace {

constexpr double kWarnPeriod = 1.0;  // [s]

class ArmControllerNode {
 public:
  ArmControllerNode(ros::NodeHandle& node, const NodeParams& params)
      : params_(params),
        controller_(params.controller),
        live_(ros::NodeHandle("~"),
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
    joints_ = node.subscribe("joint_states", 1000, &ArmControllerNode::on_joints, this, hints);
    setpoint_ =
        node.subscribe("execution/setpoint", 1000, &ArmControllerNode::on_setpoint, this, hints);
    // After subscribing: who sees this publisher may start, nothing will be missed.
    status_ = node.advertise<prf_msgs::ControlStatus>("control/status", 1000);
    command_ = node.advertise<trajectory_msgs::JointTrajectory>("joint_command", 1000);
  }

 private:
  void on_joints(const sensor_msgs::JointState& message) {
    const auto sample = from_message(message, params_.joint_names);
    if (!sample) {
      ++incomplete_joint_states_;
      ROS_WARN_THROTTLE(kWarnPeriod, "joint_states without all joints of the arm: ignored");
      return;
    }
    const auto begin = std::chrono::steady_clock::now();
    const auto answers = controller_.add_joints(*sample);
    publish(answers, begin);
  }

  void on_setpoint(const trajectory_msgs::MultiDOFJointTrajectory& message) {
    const auto begin = std::chrono::steady_clock::now();
    const auto answers =
        controller_.add_setpoint(to_ns(message.header.stamp), from_message(message, params_));
    publish(answers, begin);
  }

  void publish(const std::vector<Answer>& answers, std::chrono::steady_clock::time_point begin) {
    for (const Answer& answer : answers) {
      command_.publish(command_message(answer, params_.joint_names));
      status_.publish(status_message(answer));
      log(answer);
      last_ = answer;
    }
    if (!answers.empty()) {
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
      longest_answer_ = std::max(longest_answer_, spent.count());
    }
    diagnostics_.update();
  }

  void log(const Answer& answer) {
    const bool first_of_its_kind = answer.code != last_.code || answer.restarted;
    if (answer.reason.empty() || !first_of_its_kind) return;
    if (answer.restarted) {
      ROS_WARN("%s", answer.reason.c_str());
    } else {
      ROS_WARN_THROTTLE(kWarnPeriod, "%s", answer.reason.c_str());
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
    out.add("set-points gone silent", joiner.silences);
    out.add("set-points late", joiner.late_setpoints);
    out.add("set-points invalid", counts.invalid_setpoints);
    out.add("joint_states incomplete", incomplete_joint_states_);
    out.add("joint_states not finite", counts.faulty_joints);
    out.add("joint_states of one stamp", joiner.duplicate_ticks);
    out.add("jumps refused", counts.refused_jumps);
    out.add("ticks of slow changes of branch", counts.branch_changing);
    out.add("starts from measured joints", counts.restarts);
    out.add("runs begun by going back in time", joiner.new_runs);
    out.add("longest answer [ms]", 1e3 * longest_answer_);
  }

  NodeParams params_;
  ArmController controller_;
  prf_ros::ReconfigurableParams live_;
  ros::Publisher command_, status_;
  ros::Subscriber joints_, setpoint_;
  diagnostic_updater::Updater diagnostics_;
  Answer last_;
  std::uint64_t incomplete_joint_states_ = 0;
  double longest_answer_ = 0.0;
};

}  // namespace
}  // namespace prf_control

int main(int argc, char** argv) {
  ros::init(argc, argv, "arm_controller");
  ros::NodeHandle node;
  return prf_ros::run([&node] {
    prf_control::ArmControllerNode controller(node, prf_control::read_params(ros::NodeHandle("~")));
    ros::spin();
  });
}
