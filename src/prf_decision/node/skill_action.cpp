// SPDX-License-Identifier: BSD-3-Clause
#include "skill_action.hpp"

#include <algorithm>
#include <cmath>
#include <prf_ros/conversions.hpp>
#include <stdexcept>

#include "conversions.hpp"

namespace prf_decision {
namespace {

using std::chrono::milliseconds;

// rad/s, of every joint of a standing arm: 0.2 mrad in a tick.
constexpr double kStill = 0.02;
// Data time. The joints of the Jaco2 (at most 0.84 rad/s) brake at 4 rad/s^2 within 0.21 s.
constexpr Duration kMaxBraking = milliseconds(1000);
constexpr Duration kFeedbackPeriod = milliseconds(100);  // data time, while the state lasts

prf_msgs::ExecuteSkillResult result_of(std::uint8_t code, const std::string& text) {
  prf_msgs::ExecuteSkillResult result;
  result.code = code;
  result.text = text;
  return result;
}

SkillGoal to_core(const prf_msgs::ExecuteSkillGoal& goal) {
  return {prf_ros::to_core(goal.time_limit), prf_ros::to_core(goal.hold_time), goal.resume != 0,
          goal.demonstration};
}

}  // namespace

SkillAction::SkillAction(const ros::NodeHandle& node, const Robot& robot, SkillExecutive& executive)
    : robot_(robot),
      executive_(executive),
      server_(
          node, "execute_skill", [this](Server::GoalHandle goal) { on_goal(goal); },
          [this](Server::GoalHandle goal) { on_cancel(goal); }, false) {}

void SkillAction::see_joints(const sensor_msgs::JointState& joints) {
  arm_moves_ = false;
  const std::size_t count = std::min(joints.name.size(), joints.velocity.size());
  for (std::size_t i = 0; i < count; ++i) {
    const bool moves = !(std::abs(joints.velocity[i]) <= kStill);
    arm_moves_ = arm_moves_ || (moves && arm_joint(robot_, joints.name[i]));
  }
}

std::string SkillAction::refusal(const prf_msgs::ExecuteSkillGoal& goal) const {
  if (!executive_.can_begin()) return "an execution is under way";
  try {
    to_core(goal).validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void SkillAction::on_goal(Server::GoalHandle goal) {
  const std::string reason = refusal(*goal.getGoal());
  if (!reason.empty()) {
    ROS_WARN("goal of execute_skill refused: %s", reason.c_str());
    goal.setRejected(result_of(Result::REFUSED, reason), reason);
    return;
  }
  executive_.begin(to_core(*goal.getGoal()));
  goal_ = Current{goal, executive_.is_requesting(), {}, {}};
  if (!goal_->pending) goal_->handle.setAccepted();
}

void SkillAction::on_cancel(Server::GoalHandle goal) {
  if (goal_ && goal == goal_->handle) executive_.preempt();
}

// A pending goal, at the tick at which the planner has answered.
void SkillAction::decide_pending(const Progress& progress) {
  if (executive_.is_requesting()) return;
  goal_->pending = false;
  Server::GoalHandle& goal = goal_->handle;
  if (progress.refusal.empty()) {
    goal.setAccepted();
    return;
  }
  const bool recalled = goal.getGoalStatus().status == actionlib_msgs::GoalStatus::RECALLING;
  const auto result = result_of(recalled ? Result::PREEMPTED : Result::REFUSED, progress.refusal);
  if (recalled) {
    goal.setCanceled(result, progress.refusal);
  } else {
    ROS_WARN("goal of execute_skill refused: %s", progress.refusal.c_str());
    goal.setRejected(result, progress.refusal);
  }
  goal_.reset();
}

void SkillAction::update(const Progress& progress) {
  if (goal_ && goal_->pending) decide_pending(progress);
  if (!goal_ || goal_->pending) return;
  give_feedback(progress);
  if (progress.state == ExecutionState::kDone) {
    goal_->handle.setSucceeded(result_of(Result::DONE, progress.reason), progress.reason);
    goal_.reset();
  } else if (goal_->stopped || progress.state == ExecutionState::kStopped) {
    if (!goal_->stopped) goal_->stopped = progress;
    // A stopped execution may leave the target at once: then it brakes no longer.
    const bool braking = progress.state == ExecutionState::kStopped && arm_moves_ &&
                         progress.stamp - goal_->stopped->stamp < kMaxBraking;
    if (!braking) give_up(Progress(*goal_->stopped));
  }
}

void SkillAction::give_up(const Progress& progress) {
  if (progress.cause == Event::kPreempted) {
    goal_->handle.setCanceled(result_of(Result::PREEMPTED, progress.reason), progress.reason);
  } else {
    const auto code = progress.cause == Event::kTimeUp   ? Result::TIME_UP
                      : progress.cause == Event::kGiveUp ? Result::ARM_FAILED
                                                         : Result::TARGET_LOST;
    goal_->handle.setAborted(result_of(code, progress.reason), progress.reason);
  }
  goal_.reset();
}

void SkillAction::end_run() {
  if (!goal_) return;
  const std::string text = "the data's clock went back: new run";
  const auto result = result_of(Result::RUN_ENDED, text);
  if (goal_->pending) {
    goal_->handle.setRejected(result, text);
  } else {
    goal_->handle.setAborted(result, text);
  }
  goal_.reset();
}

void SkillAction::tell_missing(const std::string& what) {
  if (!goal_ || goal_->pending) return;
  prf_msgs::ExecuteSkillFeedback feedback;
  feedback.state = static_cast<std::uint8_t>(goal_->feedback_state);
  feedback.reason = what;
  feedback.cursor = goal_->feedback_cursor;
  feedback.goal_distance = feedback.axis_distance = -1;
  goal_->handle.publishFeedback(feedback);
}

void SkillAction::give_feedback(const Progress& progress) {
  const bool due = !goal_->feedback_given || progress.state != goal_->feedback_state ||
                   progress.stamp - *goal_->feedback_given >= kFeedbackPeriod;
  if (!due) return;
  goal_->feedback_given = progress.stamp;
  goal_->feedback_state = progress.state;
  prf_msgs::ExecuteSkillFeedback feedback;
  feedback.state = static_cast<std::uint8_t>(progress.state);
  feedback.reason = progress.reason;
  feedback.cursor = goal_->feedback_cursor = progress.fraction;
  feedback.goal_distance = progress.goal_distance ? progress.goal_distance->distance : -1;
  feedback.axis_distance = progress.goal_distance ? progress.goal_distance->axis : -1;
  goal_->handle.publishFeedback(feedback);
}

}  // namespace prf_decision
