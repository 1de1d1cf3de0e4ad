// SPDX-License-Identifier: BSD-3-Clause
#include "skill_planner_node.hpp"

#include <prf_msgs/topics.h>

#include <algorithm>
#include <prf_core/require.hpp>
#include <stdexcept>

#include "conversions.hpp"

namespace elte_planner {
namespace {

namespace topics = prf_msgs::topics;

// Throws for a message that its stream does not take; the stamp before it tells little.
void require_in_order(prf_core::StampOrder order, const ros::Time& stamp) {
  using prf_core::StampOrder;
  const char* const must = order == StampOrder::kOld         ? "newer than the ones before"
                           : order == StampOrder::kDuplicate ? "a new one: it came twice"
                                                             : "at most 1 s after the one before";
  const bool good = prf_core::is_accepted(order);
  prf_core::require(good, "stamp", std::to_string(stamp.toSec()) + " s", must);
}

}  // namespace

SkillPlannerNode::SkillPlannerNode(const SkillPlannerParams& params)
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

void SkillPlannerNode::warn_of_lost_shape() const {
  if (const auto warning = skill_.session().shape_warning(); !warning.empty()) {
    ROS_WARN("%s", warning.c_str());
  }
}

void SkillPlannerNode::on_forecast(const prf_msgs::TargetForecast& message) {
  try {
    take(message);
  } catch (const std::invalid_argument& refusal) {
    ++dropped_forecasts_;
    ROS_WARN_THROTTLE(1.0, "%s dropped (%zu so far): %s", topics::kTargetForecast,
                      dropped_forecasts_, refusal.what());
  }
  plan_decided_requests();
}

void SkillPlannerNode::on_progress(const prf_msgs::ExecutionProgress& message) {
  try {
    take(message);
  } catch (const std::invalid_argument& refusal) {
    ++dropped_progress_;
    ROS_WARN_THROTTLE(1.0, "%s dropped (%zu so far): %s", topics::kExecutionProgress,
                      dropped_progress_, refusal.what());
  }
  plan_decided_requests();
}

void SkillPlannerNode::take(const prf_msgs::TargetForecast& message) {
  require_frame(message.header.frame_id, params_.files.frame);
  const auto [forecast, refusal] = forecast_from(message);
  if (!refusal.empty()) ROS_WARN_THROTTLE(1.0, "forecast taken as lost: %s", refusal.c_str());
  refused_ += refusal.empty() ? 0 : 1;
  require_in_order(queue_.add(forecast), message.header.stamp);
}

void SkillPlannerNode::take(const prf_msgs::ExecutionProgress& message) {
  require_frame(message.header.frame_id, params_.files.frame);
  const Progress progress = progress_from(message);
  progress.validate(params_.session.nodes);
  require_in_order(queue_.add(progress), message.header.stamp);
}

void SkillPlannerNode::plan_decided_requests() {
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
  const SkillResult result =
      skill_.session().plan(progress, request.forecast ? &*request.forecast : nullptr);
  note_solve_time(std::chrono::steady_clock::now() - start);
  status_ = result.status;
  message_ = result.message;
  if (status_ == SkillStatus::kKept) {
    ++kept_;
    ROS_WARN_THROTTLE(1.0, "plan kept: %s", message_.c_str());
  }
  return trajectory_for(progress, skill_, result);
}

// Only reports: the plan must not depend on the speed of the machine.
void SkillPlannerNode::note_solve_time(std::chrono::duration<double> time) {
  solve_time_ = time;
  longest_solve_ = std::max(longest_solve_, time);
  if (!is_late()) return;
  ++late_;
  ROS_WARN_THROTTLE(1.0, "solve took %.6f s, above late_after = %g s; %zu of %zu were late",
                    time.count(), params_.late_after, late_, requests_ + 1);
}

void SkillPlannerNode::diagnose(Status& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const std::size_t drops = dropped_progress_ + dropped_forecasts_ + refused_;
  status.summary(DiagnosticStatus::OK, requests_ == 0 ? "nothing was asked yet" : "planning");
  if (requests_ > 0 && status_ != SkillStatus::kSolved) {
    status.summary(DiagnosticStatus::WARN, message_);
  } else if (is_late()) {
    status.summary(DiagnosticStatus::WARN, "the last solve was late; its plan was sent");
  } else if (drops > drops_reported_) {
    status.summary(DiagnosticStatus::WARN, "messages were dropped or refused");
  }
  drops_reported_ = drops;
  status.add("plans sent", requests_);
  status.add("kept plans", kept_);
  status.add("late solves", late_);
  status.add("progress dropped", dropped_progress_);
  status.add("forecasts dropped", dropped_forecasts_);
  status.add("forecasts refused", refused_);
  status.add("requests waiting for their forecast", queue_.waiting());
  status.add("last solve time, us", 1e6 * solve_time_.count());
  status.add("longest solve time, us", 1e6 * longest_solve_.count());
}

}  // namespace elte_planner
