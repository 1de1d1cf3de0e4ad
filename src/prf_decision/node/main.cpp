// SPDX-License-Identifier: BSD-3-Clause
#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/SpeedScale.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <map>
#include <prf_core/quoted.hpp>
#include <prf_ros/conversions.hpp>
#include <prf_ros/input_monitor.hpp>
#include <prf_ros/reconfigurable.hpp>
#include <prf_ros/wall_throttle.hpp>
#include <sstream>

#include "conversions.hpp"
#include "params.hpp"
#include "skill_action.hpp"

namespace prf_decision {
namespace {

constexpr std::uint32_t kQueue = 1000;
constexpr double kTickSilence = 2.0;  // s of wall time, after which a client is told

class DecisionNode {
 public:
  explicit DecisionNode(const DecisionNodeParams& params)
      : params_(params),
        gate_(params.gate),
        executive_(params.decision),
        action_(node_, params.robot, executive_),
        inputs_(node_, &diagnostics_),
        reconfigurable_(ros::NodeHandle("~"), reconfigurable_numbers(params.decision),
                        [this](const ReconfigurableParams::Values& values) { tune(values); }) {
    subscribe();
    // After subscribing: whoever sees this publisher may start, nothing will be missed.
    setpoints_ =
        node_.advertise<trajectory_msgs::MultiDOFJointTrajectory>("execution/setpoint", kQueue);
    progresses_ = node_.advertise<prf_msgs::ExecutionProgress>("execution/progress", kQueue);
    diagnostics_.setHardwareID("none");
    diagnostics_.add("decision", this, &DecisionNode::diagnose);
    watchdog_ = node_.createWallTimer(ros::WallDuration(1.0), &DecisionNode::tell_silence, this);
    action_.start();
  }

 private:
  using ReconfigurableParams = prf_ros::ReconfigurableParams;

  void subscribe() {
    const std::string& frame = params_.robot.base_link;
    const double tick_rate = 1 / params_.tick_period;
    const double camera_rate = 1 / to_seconds(params_.gate.camera_period);
    inputs_.subscribe<sensor_msgs::JointState>(
        {"joint_states", "sensor_msgs/JointState with " + first_joint() + " and the others",
         tick_rate},
        kQueue,
        [this](const sensor_msgs::JointStateConstPtr& message) { on_joint_states(*message); });
    inputs_.subscribe<prf_msgs::TargetForecast>(
        {"target/forecast", "prf_msgs/TargetForecast in " + frame, camera_rate}, kQueue,
        [this](const prf_msgs::TargetForecastConstPtr& message) { on_forecast(*message); });
    inputs_.subscribe<prf_msgs::SkillTrajectory>(
        {"skill/trajectory", "prf_msgs/SkillTrajectory, one for each forecast that progress names",
         0.0, prf_ros::Presence::kOnDemand},
        kQueue,
        [this](const prf_msgs::SkillTrajectoryConstPtr& message) { on_trajectory(*message); });
    inputs_.subscribe<prf_msgs::ControlStatus>(
        {"control/status", "prf_msgs/ControlStatus, one for each tick", tick_rate}, kQueue,
        [this](const prf_msgs::ControlStatusConstPtr& message) { on_control_status(*message); });
    inputs_.subscribe<prf_msgs::SpeedScale>(
        {"speed_scale", "prf_msgs/SpeedScale, 0 to 1", 0.0, prf_ros::Presence::kOnDemand}, kQueue,
        [this](const prf_msgs::SpeedScaleConstPtr& message) { on_speed_scale(*message); });
  }

  void tune(const ReconfigurableParams::Values& values) {
    const DecisionParams tuned = with_reconfigured(params_.decision, values);
    executive_.tune(tuned);
    params_.decision = tuned;
  }

  void on_joint_states(const sensor_msgs::JointState& message) {
    const std::string missing = missing_joints(params_.robot, message);
    if (!missing.empty()) {  // no tick: perhaps the legs of the robot, by a sender of their own
      inputs_.drop("joint_states", "without " + missing + ": no tick");
      return;
    }
    action_.see_joints(message);
    const Stamp stamp = prf_ros::to_core(message.header.stamp);
    const auto joints = measured_joints(params_.robot, message);
    const auto hand =
        joints ? std::optional(prf_core::pose_from(params_.robot.kinematics->forward(*joints)))
               : std::nullopt;
    account("joint_states", stamp, gate_.push_tick(stamp, hand, joints));
    process();
  }

  void on_forecast(const prf_msgs::TargetForecast& message) {
    ForecastArrival arrival{prf_ros::to_core(message.header.stamp), nullptr};
    try {
      arrival.forecast = to_core(params_.robot, message);
    } catch (const std::invalid_argument& error) {
      refuse("target/forecast", error.what());
    }
    const Stamp stamp = arrival.stamp;
    account("target/forecast", stamp, gate_.push_forecast(std::move(arrival)));
    process();
  }

  void on_trajectory(const prf_msgs::SkillTrajectory& message) {
    PlanResult result = to_plan_result(params_.robot, message);
    if (!has_plan(message)) {
      count("skill/trajectory without a plan");
    } else if (!result.plan) {
      refuse("skill/trajectory", result.message);
    }
    const Stamp stamp = result.stamp;
    account("skill/trajectory", stamp, gate_.push_plan_result(std::move(result)));
    process();
  }

  void on_control_status(const prf_msgs::ControlStatus& message) {
    const ControlReport report = to_core(message);
    account("control/status", report.stamp, gate_.push_control_report(report));
    process();
  }

  void on_speed_scale(const prf_msgs::SpeedScale& message) {
    try {
      executive_.scale_speed(prf_ros::to_core(message.header.stamp), message.scale);
    } catch (const std::invalid_argument& error) {
      refuse("speed_scale", error.what());
    }
  }

  void refuse(const std::string& topic, const std::string& reason) {
    inputs_.drop(topic, "refused");
    if (!told_.is_due(topic + " refused")) return;
    ROS_WARN("%s refused: %s", topic.c_str(), prf_core::quoted(reason).c_str());
  }

  void account(const std::string& topic, Stamp stamp, PushResult push) {
    if (push == PushResult::kOld || push == PushResult::kFarAhead) {
      inputs_.drop(topic, push == PushResult::kOld
                              ? "old: not newer than the one before, or older than the run"
                              : "far ahead of the ticks, or of its own stream");
      if (told_.is_due(topic + " dropped")) {
        ROS_WARN("%s of %.3f s dropped, the newest tick is of %.3f s", topic.c_str(),
                 to_seconds(stamp), to_seconds(gate_.newest_tick().value_or(Stamp{0})));
      }
    }
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
      if (tick->control_silent) report_silent("control/status");
      const auto [progress, setpoint] = executive_.update(*tick);
      progresses_.publish(to_message(params_.robot, progress));
      setpoints_.publish(to_message(params_.robot, tick->stamp, setpoint));
      if (progress.state != last_.state) {
        ROS_INFO("%s -> %s: %s", name(last_.state), name(progress.state), progress.reason.c_str());
      }
      action_.update(progress);
      last_ = progress;
      last_processed_ = ros::WallTime::now();
      count("ticks");
      diagnostics_.update();
    }
  }

  void report_silent(const std::string& topic) {
    count("ticks without " + topic);
    silent_ = topic;
    if (told_.is_due(topic + " silent")) {
      ROS_WARN("%s is silent for more than max_wait: goes on without it; does its node run?",
               topic.c_str());
    }
  }

  // Without ticks nothing else tells the client of the action what is missing.
  void tell_silence(const ros::WallTimerEvent&) {
    const double silence = (ros::WallTime::now() - last_processed_).toSec();
    if (silence < kTickSilence) return;
    std::ostringstream text;
    text << "no control tick for " << std::lround(silence) << " s: joint_states with "
         << first_joint() << " and the others is missing";
    action_.tell_missing(text.str());
  }

  [[nodiscard]] const std::string& first_joint() const { return params_.robot.joints.front(); }

  void count(const std::string& what) { ++counters_[what]; }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    using diagnostic_msgs::DiagnosticStatus;
    status.summary(DiagnosticStatus::OK, executive_.describe());
    if (executive_.belief_resets() > 0) {
      status.mergeSummary(DiagnosticStatus::WARN, "the HMM's belief was no distribution: reset");
    }
    if (!silent_.empty()) status.mergeSummary(DiagnosticStatus::ERROR, silent_ + " is silent");
    if (!executive_.following_trouble().empty()) {
      status.mergeSummary(DiagnosticStatus::ERROR, executive_.following_trouble());
    }
    silent_.clear();
    for (const auto& [what, number] : counters_) status.add(what, number);
    status.add("resets of the HMM's belief", executive_.belief_resets());
    inputs_.report(status);
  }

  ros::NodeHandle node_;
  DecisionNodeParams params_;
  TickGate gate_;
  SkillExecutive executive_;
  SkillAction action_;
  diagnostic_updater::Updater diagnostics_;
  prf_ros::InputMonitor inputs_;
  ReconfigurableParams reconfigurable_;
  Progress last_;
  std::map<std::string, std::size_t> counters_;
  std::string silent_;  // a topic that was silent since the last diagnostics; or none
  prf_ros::WallThrottles told_;
  ros::WallTime last_processed_ = ros::WallTime::now();
  ros::Publisher progresses_;
  ros::Publisher setpoints_;
  ros::WallTimer watchdog_;
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
