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

constexpr double kStill = 0.02;                          // rad/s, of every joint of a standing arm
constexpr Duration kMaxBraking = milliseconds(1000);     // data time
constexpr Duration kFeedbackPeriod = milliseconds(100);  // data time, while the state lasts

prf_msgs::ExecuteSkillResult result_of(std::uint8_t code, const std::string& text) {
  prf_msgs::ExecuteSkillResult result;
  result.code = code;
  result.text = text;
  return result;
}

Order order_of(const prf_msgs::ExecuteSkillGoal& goal) {
  return {prf_ros::to_core(goal.time_limit), prf_ros::to_core(goal.hold_time), goal.resume != 0,
          goal.demonstration};
}

}  // namespace

SkillAction::SkillAction(const ros::NodeHandle& node, const RobotNames& robot, Decision& decision)
    : robot_(robot),
      decision_(decision),
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
  if (!decision_.can_begin()) return "an execution is under way";
  try {
    order_of(goal).validate();
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
  decision_.begin(order_of(*goal.getGoal()));
  goal_ = goal;
  stopped_.reset();
  feedback_given_.reset();
  pending_ = decision_.is_asking();
  if (!pending_) goal_->setAccepted();
}

void SkillAction::on_cancel(Server::GoalHandle goal) {
  if (goal_ && goal == *goal_) decision_.preempt();
}

// Asked of the planner, until the tick at which it has answered.
void SkillAction::decide_pending(const Progress& progress) {
  if (decision_.is_asking()) return;
  pending_ = false;
  if (progress.refusal.empty()) {
    goal_->setAccepted();
    return;
  }
  const bool recalled = goal_->getGoalStatus().status == actionlib_msgs::GoalStatus::RECALLING;
  const auto result = result_of(recalled ? Result::PREEMPTED : Result::REFUSED, progress.refusal);
  if (recalled) {
    goal_->setCanceled(result, progress.refusal);
  } else {
    ROS_WARN("goal of execute_skill refused: %s", progress.refusal.c_str());
    goal_->setRejected(result, progress.refusal);
  }
  goal_.reset();
}

void SkillAction::update(const Progress& progress) {
  if (goal_ && pending_) decide_pending(progress);
  if (!goal_ || pending_) return;
  give_feedback(progress);
  if (progress.state == State::kDone) {
    goal_->setSucceeded(result_of(Result::DONE, progress.reason), progress.reason);
    goal_.reset();
  } else if (progress.state == State::kStopped) {
    if (!stopped_) stopped_ = progress.stamp;
    const bool braking = arm_moves_ && progress.stamp - *stopped_ < kMaxBraking;
    if (!braking) give_up(progress);
  }
}

void SkillAction::give_up(const Progress& progress) {
  if (progress.cause == Event::kPreempted) {
    goal_->setCanceled(result_of(Result::PREEMPTED, progress.reason), progress.reason);
  } else {
    const auto code = progress.cause == Event::kTimeUp ? Result::TIME_UP : Result::TARGET_LOST;
    goal_->setAborted(result_of(code, progress.reason), progress.reason);
  }
  goal_.reset();
}

void SkillAction::end_run() {
  if (!goal_) return;
  const std::string text = "the data's clock went back: new run";
  const auto result = result_of(Result::RUN_ENDED, text);
  pending_ ? goal_->setRejected(result, text) : goal_->setAborted(result, text);
  goal_.reset();
  pending_ = false;
}

void SkillAction::give_feedback(const Progress& progress) {
  const bool due = !feedback_given_ || progress.state != feedback_state_ ||
                   progress.stamp - *feedback_given_ >= kFeedbackPeriod;
  if (!due) return;
  feedback_given_ = progress.stamp;
  feedback_state_ = progress.state;
  prf_msgs::ExecuteSkillFeedback feedback;
  feedback.state = static_cast<std::uint8_t>(progress.state);
  feedback.reason = progress.reason;
  feedback.cursor = progress.share;
  feedback.goal_distance = progress.goal_distance.value_or(-1);
  feedback.axis_distance = progress.axis_distance.value_or(-1);
  goal_->publishFeedback(feedback);
}

}  // namespace prf_decision
