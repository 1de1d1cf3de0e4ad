// SPDX-License-Identifier: BSD-3-Clause
#include <diagnostic_updater/diagnostic_updater.h>
#include <prf_msgs/topics.h>
#include <ros/ros.h>

#include <chrono>
#include <prf_ros/private_parameters.hpp>

#include "conversions.hpp"
#include "elte_planner/current_skill.hpp"
#include "elte_planner/request_queue.hpp"
#include "params.hpp"

namespace elte_planner {
namespace {

namespace topics = prf_msgs::topics;

class SkillPlannerNode {
 public:
  explicit SkillPlannerNode(const SkillPlannerParams& params)
      : params_(params), skill_(params.session, params.files) {
    warn_of_lost_shape();
    const auto hints = ros::TransportHints().tcpNoDelay();
    forecast_ =
        node_.subscribe(topics::kTargetForecast, 100, &SkillPlannerNode::on_forecast, this, hints);
    progress_ = node_.subscribe(topics::kExecutionProgress, 1000, &SkillPlannerNode::on_progress,
                                this, hints);
    // Advertised last: whoever sees this publisher may send, both topics are subscribed.
    trajectory_ = node_.advertise<prf_msgs::SkillTrajectory>(topics::kSkillTrajectory, 100);
    updater_.setHardwareID("none");
    updater_.add("planner", this, &SkillPlannerNode::diagnose);
  }

 private:
  void warn_of_lost_shape() const {
    if (const auto warning = skill_.session().shape_warning(); !warning.empty()) {
      ROS_WARN("%s", warning.c_str());
    }
  }

  bool in_planning_frame(const std_msgs::Header& header, const char* topic) {
    if (header.frame_id == params_.files.frame) return true;
    ++wrong_frame_;
    ROS_WARN_THROTTLE(5.0, "%s is in frame '%s', must be '%s': dropped", topic,
                      header.frame_id.c_str(), params_.files.frame.c_str());
    return false;
  }

  void on_forecast(const prf_msgs::TargetForecast& message) {
    if (!in_planning_frame(message.header, topics::kTargetForecast)) return;
    const auto [forecast, refusal] = forecast_from(message);
    if (!refusal.empty()) ROS_WARN_THROTTLE(5.0, "forecast taken as lost: %s", refusal.c_str());
    refused_ += refusal.empty() ? 0 : 1;
    queue_.add(forecast);
    plan_decided_requests();
  }

  void on_progress(const prf_msgs::ExecutionProgress& message) {
    if (!in_planning_frame(message.header, topics::kExecutionProgress)) return;
    queue_.add(progress_from(message));
    plan_decided_requests();
  }

  void plan_decided_requests() {
    while (const auto request = queue_.next()) {
      if (request->new_run) {
        ROS_INFO("stamps went back: new run");
        skill_.reset();
      }
      trajectory_.publish(plan(*request));
      ++requests_;
    }
    updater_.update();
  }

  prf_msgs::SkillTrajectory plan(const JoinedRequest& request) {
    const Progress& progress = request.progress;
    const std::string before = skill_.demonstration();
    if (const auto reason = skill_.select(progress.demonstration)) {
      if (message_ != *reason) ROS_WARN("demonstration refused: %s", reason->c_str());
      status_ = SkillStatus::kNoPlan;
      message_ = *reason;
      return refusal_for(progress, skill_, *reason);
    }
    if (skill_.demonstration() != before) {
      ROS_INFO("demonstration is now %s", skill_.demonstration().c_str());
      warn_of_lost_shape();
    }
    const auto start = std::chrono::steady_clock::now();
    const SkillResult result =
        skill_.session().plan(progress, request.forecast ? &*request.forecast : nullptr);
    note_solve_time(std::chrono::steady_clock::now() - start);
    status_ = result.status;
    message_ = result.message;
    if (status_ == SkillStatus::kKept) ROS_WARN_THROTTLE(5.0, "plan kept: %s", message_.c_str());
    if (status_ == SkillStatus::kKept) ++kept_;
    return trajectory_for(progress, skill_, result);
  }

  // Only reports: the plan must not depend on the speed of the machine.
  void note_solve_time(std::chrono::duration<double> time) {
    solve_time_ = time;
    if (!is_late()) return;
    ++late_;
    ROS_WARN_THROTTLE(5.0, "solve took %.6f s, above late_after", time.count());
  }

  bool is_late() const { return solve_time_.count() > params_.late_after; }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    using diagnostic_msgs::DiagnosticStatus;
    const bool good = (status_ == SkillStatus::kSolved && !is_late()) || requests_ == 0;
    const std::string usual = is_late() ? "solve was late" : "planning";
    status.summary(good ? DiagnosticStatus::OK : DiagnosticStatus::WARN,
                   message_.empty() ? usual : message_);
    status.add("plans sent", requests_);
    status.add("kept plans", kept_);
    status.add("late solves", late_);
    status.add("dropped, wrong frame", wrong_frame_);
    status.add("forecasts refused", refused_);
    status.add("requests waiting for their forecast", queue_.waiting());
    status.add("last solve time, us", 1e6 * solve_time_.count());
  }

  SkillPlannerParams params_;
  CurrentSkill skill_;
  RequestQueue queue_;
  std::size_t requests_ = 0, kept_ = 0, late_ = 0, wrong_frame_ = 0, refused_ = 0;
  SkillStatus status_ = SkillStatus::kNoPlan;
  std::string message_;
  std::chrono::duration<double> solve_time_{0.0};

  ros::NodeHandle node_;
  ros::Publisher trajectory_;
  ros::Subscriber forecast_, progress_;
  diagnostic_updater::Updater updater_;
};

}  // namespace
}  // namespace elte_planner

int main(int argc, char** argv) {
  ros::init(argc, argv, "skill_planner");
  return prf_ros::run([] {
    elte_planner::SkillPlannerNode node(elte_planner::load_params(ros::NodeHandle("~")));
    ros::spin();
  });
}
