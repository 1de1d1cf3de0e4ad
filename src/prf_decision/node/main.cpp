// SPDX-License-Identifier: BSD-3-Clause
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <map>
#include <prf_ros/conversions.hpp>
#include <prf_ros/reconfigurable.hpp>

#include "conversions.hpp"
#include "params.hpp"
#include "skill_action.hpp"

namespace prf_decision {
namespace {

constexpr std::uint32_t kQueue = 1000;
constexpr double kWarnPeriod = 1.0;  // s

class DecisionNode {
 public:
  explicit DecisionNode(const DecisionNodeParams& params)
      : params_(params),
        gate_(params.gate),
        executive_(params.decision),
        action_(node_, params.robot, executive_),
        reconfigurable_(ros::NodeHandle("~"), reconfigurable_numbers(params.decision),
                        [this](const ReconfigurableParams::Values& values) { tune(values); }) {
    const auto hints = ros::TransportHints().tcpNoDelay();
    subscribers_ = {
        node_.subscribe("joint_states", kQueue, &DecisionNode::on_joint_states, this, hints),
        node_.subscribe("target/forecast", kQueue, &DecisionNode::on_forecast, this, hints),
        node_.subscribe("skill/trajectory", kQueue, &DecisionNode::on_trajectory, this, hints)};
    // After subscribing: whoever sees this publisher may start, nothing will be missed.
    setpoints_ =
        node_.advertise<trajectory_msgs::MultiDOFJointTrajectory>("execution/setpoint", kQueue);
    progresses_ = node_.advertise<prf_msgs::ExecutionProgress>("execution/progress", kQueue);
    diagnostics_.setHardwareID("none");
    diagnostics_.add("decision", this, &DecisionNode::diagnose);
    action_.start();
  }

 private:
  using ReconfigurableParams = prf_ros::ReconfigurableParams;

  void tune(const ReconfigurableParams::Values& values) {
    const DecisionParams tuned = with_reconfigured(params_.decision, values);
    executive_.tune(tuned);
    params_.decision = tuned;
  }

  void on_joint_states(const sensor_msgs::JointState& message) {
    action_.see_joints(message);
    account("joint_states", gate_.push_tick(prf_ros::to_core(message.header.stamp),
                                            measured_hand(params_.robot, message)));
    process();
  }

  void on_forecast(const prf_msgs::TargetForecast& message) {
    ForecastArrival arrival{prf_ros::to_core(message.header.stamp), nullptr};
    try {
      arrival.forecast = to_core(params_.robot, message);
    } catch (const std::invalid_argument& error) {
      refuse("target/forecast", error.what());
    }
    account("target/forecast", gate_.push_forecast(std::move(arrival)));
    process();
  }

  void on_trajectory(const prf_msgs::SkillTrajectory& message) {
    PlanResult result = to_plan_result(params_.robot, message);
    if (!has_plan(message)) {
      count("skill/trajectory without a plan");
    } else if (!result.plan) {
      refuse("skill/trajectory", result.message);
    }
    account("skill/trajectory", gate_.push_plan_result(std::move(result)));
    process();
  }

  void refuse(const std::string& topic, const std::string& reason) {
    count(topic + " refused");
    ROS_WARN_THROTTLE(kWarnPeriod, "%s refused: %s", topic.c_str(), reason.c_str());
  }

  void account(const std::string& topic, PushResult push) {
    if (push == PushResult::kOld) count(topic + " dropped as old");
    if (push == PushResult::kFarAhead) count(topic + " dropped as far ahead");
    if (push != PushResult::kNewRun) return;
    ROS_WARN("clock of %s went back: new run", topic.c_str());
    executive_ = SkillExecutive(params_.decision);
    action_.end_run();
    last_ = Progress();
    diagnostics_.force_update();
  }

  void process() {
    while (const auto tick = gate_.next()) {
      if (tick->forecast_silent) report_silent("target/forecast");
      if (tick->planner_silent) report_silent("skill/trajectory");
      const auto [progress, setpoint] = executive_.update(*tick);
      progresses_.publish(to_message(params_.robot, progress));
      setpoints_.publish(to_message(params_.robot, tick->stamp, setpoint));
      if (progress.state != last_.state) {
        ROS_INFO("%s -> %s: %s", name(last_.state), name(progress.state), progress.reason.c_str());
      }
      action_.update(progress);
      last_ = progress;
      count("ticks");
      diagnostics_.update();
    }
  }

  void report_silent(const std::string& topic) {
    count("ticks without " + topic);
    ROS_WARN_THROTTLE(kWarnPeriod, "%s is silent, see max_wait", topic.c_str());
  }

  void count(const std::string& what) { ++counters_[what]; }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, executive_.describe());
    for (const auto& [what, number] : counters_) status.add(what, number);
  }

  ros::NodeHandle node_;
  DecisionNodeParams params_;
  TickGate gate_;
  SkillExecutive executive_;
  SkillAction action_;
  ReconfigurableParams reconfigurable_;
  Progress last_;
  std::map<std::string, std::size_t> counters_;
  ros::Publisher progresses_;
  ros::Publisher setpoints_;
  std::vector<ros::Subscriber> subscribers_;
  diagnostic_updater::Updater diagnostics_;
};

}  // namespace
}  // namespace prf_decision

int main(int argc, char** argv) {
  ros::init(argc, argv, "decision");
  return prf_ros::run([] {
    prf_decision::DecisionNode node(
        prf_decision::load_params(prf_ros::PrivateParameters(ros::NodeHandle("~"))));
    ros::spin();
  });
}
