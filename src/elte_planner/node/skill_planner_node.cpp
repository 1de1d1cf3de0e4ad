// SPDX-License-Identifier: BSD-3-Clause
#include "skill_planner_node.hpp"

#include <prf_msgs/topics.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "conversions.hpp"

namespace elte_planner {
namespace {

namespace topics = prf_msgs::topics;

// Throws for a message that its stream does not take.
void require_in_order(prf_core::StampOrder order) {
  using prf_core::StampOrder;
  if (prf_core::is_accepted(order)) return;
  throw std::invalid_argument(
      order == StampOrder::kOld         ? "its stamp is older than that of a message before"
      : order == StampOrder::kDuplicate ? "it came twice"
                                        : "its stamp is more than 1 s ahead");
}

}  // namespace

SkillPlannerNode::SkillPlannerNode(const SkillPlannerParams& params)
    : params_(params), skill_(params.session, params.files) {
  warn_of_lost_shape();
  inputs_.subscribe<prf_msgs::TargetForecast>(
      {topics::kTargetForecast,
       "prf_msgs/TargetForecast in " + params.files.frame + " from target_predictor"},
      100, [this](const prf_msgs::TargetForecast::ConstPtr& message) { on_forecast(*message); });
  inputs_.subscribe<prf_msgs::ExecutionProgress>(
      {topics::kExecutionProgress,
       "prf_msgs/ExecutionProgress in " + params.files.frame + " from decision",
       1.0 / params.tick_period},
      1000,
      [this](const prf_msgs::ExecutionProgress::ConstPtr& message) { on_progress(*message); });
  inputs_.subscribe<visualization_msgs::MarkerArray>(
      {topics::kObstacles,
       "visualization_msgs/MarkerArray in " + params.files.frame + " or " + params.target_frame +
           ", where somebody knows of obstacles",
       0.0, prf_ros::Presence::kOnDemand},
      10,
      [this](const visualization_msgs::MarkerArray::ConstPtr& message) { on_obstacles(*message); });
  // Advertised last: whoever sees this publisher may send, both topics are subscribed.
  trajectory_ = node_.advertise<prf_msgs::SkillTrajectory>(topics::kSkillTrajectory, 100);
  updater_.setHardwareID("none");
  updater_.add("planner", this, &SkillPlannerNode::diagnose);
}

void SkillPlannerNode::warn_of_lost_shape() const {
  if (const auto warning = skill_.session().shape_warning(); !warning.empty()) {
    ROS_WARN("%s", warning.c_str());
  }
}

void SkillPlannerNode::on_forecast(const prf_msgs::TargetForecast& message) {
  try {
    take(message);
  } catch (const std::invalid_argument& refusal) {
    inputs_.drop(topics::kTargetForecast, refusal.what());
  }
  plan_decided_requests();
}

void SkillPlannerNode::on_progress(const prf_msgs::ExecutionProgress& message) {
  try {
    take(message);
  } catch (const std::invalid_argument& refusal) {
    inputs_.drop(topics::kExecutionProgress, refusal.what());
  }
  plan_decided_requests();
}

void SkillPlannerNode::on_obstacles(const visualization_msgs::MarkerArray& message) {
  if (!params_.avoid) return;
  try {
    auto [stamp, obstacles] = obstacles_from(message, params_.files.frame, params_.target_frame);
    obstacles_.add(stamp, std::move(obstacles));
  } catch (const std::invalid_argument& refusal) {
    inputs_.drop(topics::kObstacles, refusal.what());
  }
}

void SkillPlannerNode::take(const prf_msgs::TargetForecast& message) {
  require_frame(message.header.frame_id, params_.files.frame);
  const auto [forecast, refusal] = forecast_from(message);
  if (!refusal.empty() && told_.is_due("lost forecast")) {
    ROS_WARN("forecast taken as lost: %s", refusal.c_str());
  }
  refused_ += refusal.empty() ? 0 : 1;
  require_in_order(queue_.add(forecast));
}

void SkillPlannerNode::take(const prf_msgs::ExecutionProgress& message) {
  require_frame(message.header.frame_id, params_.files.frame);
  const Progress progress = progress_from(message);
  progress.validate(params_.session.nodes);
  require_in_order(queue_.add(progress));
}

void SkillPlannerNode::plan_decided_requests() {
  while (const auto request = queue_.next()) {
    if (request->new_run) {
      ROS_INFO("stamps went back: new run");
      skill_.reset();
      obstacles_.begin_run(request->progress.stamp);
    }
    trajectory_.publish(plan(*request));
    ++requests_;
  }
  updater_.update();
}

prf_msgs::SkillTrajectory SkillPlannerNode::plan(const JoinedRequest& request) {
  const Progress& progress = request.progress;
  const std::string before = skill_.demonstration();
  if (const auto reason = skill_.select(progress.demonstration)) {
    if (message_ != *reason) ROS_WARN("demonstration refused: %s", reason->c_str());
    status_ = SkillStatus::kNoPlan;
    message_ = *reason;
    return refusal_for(progress, skill_, *reason);
  }
  if (skill_.demonstration() != before) {
    ROS_INFO("demonstration is now %.200s", skill_.demonstration().c_str());
    warn_of_lost_shape();
  }
  const auto start = std::chrono::steady_clock::now();
  const SkillResult result = skill_.session().plan(
      progress, request.forecast ? &*request.forecast : nullptr, obstacles_.at(progress.stamp));
  note_solve_time(std::chrono::steady_clock::now() - start);
  status_ = result.status;
  message_ = result.message;
  if (status_ == SkillStatus::kKept) {
    ++kept_;
    if (told_.is_due("plan kept")) ROS_WARN("plan kept: %s", message_.c_str());
  }
  if (status_ == SkillStatus::kBlocked) {
    ++blocked_;
    if (told_.is_due("blocked")) ROS_WARN("the way is blocked: %s", message_.c_str());
  }
  return trajectory_for(progress, skill_, result);
}

// Only reports: the plan must not depend on the speed of the machine.
void SkillPlannerNode::note_solve_time(std::chrono::duration<double> time) {
  solve_time_ = time;
  longest_solve_ = std::max(longest_solve_, time);
  solve_times_.push_back(1e6 * time.count());
  if (!is_late()) return;
  ++late_;
  if (!told_.is_due("late")) return;
  ROS_WARN("solve took %.6f s, above late_after = %g s; %zu of %zu were late", time.count(),
           params_.late_after, late_, requests_ + 1);
}

void SkillPlannerNode::diagnose(Status& status) {
  using diagnostic_msgs::DiagnosticStatus;
  status.summary(DiagnosticStatus::OK, requests_ == 0 ? "nothing was asked yet" : "planning");
  if (requests_ > 0 && status_ != SkillStatus::kSolved) {
    status.summary(DiagnosticStatus::WARN, message_);
  } else if (is_late()) {
    status.summary(DiagnosticStatus::WARN, "the last solve was late; its plan was sent");
  } else if (refused_ > refusals_reported_) {
    status.summary(DiagnosticStatus::WARN, "forecasts were refused: taken as lost");
  }
  refusals_reported_ = refused_;
  status.add("plans sent", requests_);
  status.add("kept plans", kept_);
  status.add("blocked plans", blocked_);
  status.add("obstacles of the topic", obstacles_.count());
  status.add("late solves", late_);
  status.add("forecasts refused", refused_);
  status.add("requests waiting for their forecast", queue_.waiting());
  status.add("last solve time, us", 1e6 * solve_time_.count());
  if (!solve_times_.empty()) {
    std::vector<double> sorted(solve_times_.begin(), solve_times_.end());
    std::sort(sorted.begin(), sorted.end());
    status.add("median solve time, us", sorted[sorted.size() / 2]);
    status.add("99th percentile of solve times, us", sorted[sorted.size() * 99 / 100]);
  }
  status.add("longest solve time, us", 1e6 * longest_solve_.count());
  inputs_.report(status);
}

}  // namespace elte_planner
