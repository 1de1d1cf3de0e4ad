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
        decision_(params.decision),
        action_(node_, params.robot, decision_),
        reconfigurable_(ros::NodeHandle("~"), reconfigurable_numbers(params.decision),
                        [this](const ReconfigurableParams::Values& values) { tune(values); }) {
    const auto hints = ros::TransportHints().tcpNoDelay();
    subscribers_ = {
        node_.subscribe("joint_states", kQueue, &DecisionNode::on_joint_states, this, hints),
        node_.subscribe("target/forecast", kQueue, &DecisionNode::on_forecast, this, hints),
        node_.subscribe("skill/trajectory", kQueue, &DecisionNode::on_trajectory, this, hints)};
    // After subscribing: who sees this publisher may start, nothing will be missed.
    setpoint_publisher_ =
        node_.advertise<trajectory_msgs::MultiDOFJointTrajectory>("execution/setpoint", kQueue);
    progress_publisher_ =
        node_.advertise<prf_msgs::ExecutionProgress>("execution/progress", kQueue);
    diagnostics_.setHardwareID("none");
    diagnostics_.add("decision", this, &DecisionNode::diagnose);
    action_.start();
  }

 private:
  using ReconfigurableParams = prf_ros::ReconfigurableParams;

  void tune(const ReconfigurableParams::Values& values) {
    const DecisionParams tuned = with_reconfigured(params_.decision, values);
    decision_.tune(tuned);
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
      count("target/forecast refused");
      ROS_WARN_THROTTLE(kWarnPeriod, "target/forecast refused: %s", error.what());
    }
    account("target/forecast", gate_.push_forecast(std::move(arrival)));
    process();
  }

  void on_trajectory(const prf_msgs::SkillTrajectory& message) {
    const bool refused = message.status == prf_msgs::SkillTrajectory::REFUSED;
    PlanAnswer answer{prf_ros::to_core(message.header.stamp), nullptr, "",
                      message.demonstration_switch, refused};
    if (refused || message.status == prf_msgs::SkillTrajectory::NO_PLAN) {
      answer.message = message.message;
      count("skill/trajectory without a plan");
    } else {
      try {
        answer.plan = to_core(params_.robot, message);
      } catch (const std::invalid_argument& error) {
        answer.message = error.what();
        count("skill/trajectory refused");
        ROS_WARN_THROTTLE(kWarnPeriod, "skill/trajectory refused: %s", error.what());
      }
    }
    account("skill/trajectory", gate_.push_answer(std::move(answer)));
    process();
  }

  void account(const std::string& topic, Push push) {
    if (push == Push::kOld) count(topic + " dropped as old");
    if (push == Push::kFuture) count(topic + " dropped as future");
    if (push != Push::kNewRun) return;
    ROS_WARN("clock of %s went back: new run", topic.c_str());
    decision_ = Decision(params_.decision);
    action_.end_run();
    last_ = Progress();
    diagnostics_.force_update();
  }

  void process() {
    while (const auto tick = gate_.next()) {
      if (tick->forecast_stale) report_silent("target/forecast");
      if (tick->plan_stale) report_silent("skill/trajectory");
      const auto [progress, setpoint] = decision_.update(*tick);
      progress_publisher_.publish(to_message(params_.robot, progress));
      setpoint_publisher_.publish(to_message(params_.robot, tick->stamp, setpoint));
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
    ROS_WARN_THROTTLE(kWarnPeriod, "%s is silent for more than %.2f s", topic.c_str(),
                      to_seconds(params_.gate.max_wait));
  }

  void count(const std::string& what) { ++counters_[what]; }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK,
                   std::string(name(last_.state)) + " " + last_.reason);
    for (const auto& [what, number] : counters_) status.add(what, number);
  }

  ros::NodeHandle node_;
  DecisionNodeParams params_;
  TickGate gate_;
  Decision decision_;
  SkillAction action_;
  ReconfigurableParams reconfigurable_;
  Progress last_;
  std::map<std::string, std::size_t> counters_;
  ros::Publisher progress_publisher_;
  ros::Publisher setpoint_publisher_;
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
