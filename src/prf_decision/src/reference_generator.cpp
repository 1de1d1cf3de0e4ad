// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/reference_generator.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>

#include "prf_decision/guards.hpp"

namespace prf_decision {
namespace {

bool moves_cursor(ExecutionState state) {
  return state == ExecutionState::kForward || state == ExecutionState::kReverse ||
         state == ExecutionState::kRetract;
}

bool tracks(ExecutionState state) {
  return state == ExecutionState::kTracking || state == ExecutionState::kDone;
}

// The arm stands: it stopped, or was left by a decision before this one.
bool holds(ExecutionState state) {
  return state == ExecutionState::kWaiting || state == ExecutionState::kStopped;
}

bool are_near(const Pose& a, const Pose& b, double distance) {
  constexpr double kAngle = 0.05;  // rad, 3 degrees
  return (a.position - b.position).norm() <= distance &&
         a.orientation.angularDistance(b.orientation) <= kAngle;
}

MovingPose at_rest(const Pose& pose) { return {pose, {0, 0, 0}, {0, 0, 0}}; }

}  // namespace

void ReferenceParams::validate() const {
  using prf_core::require_between;
  require_between("lead", to_seconds(lead), 0, 1, "s");
  require_between("approach_length", approach_length, 0, 2, "m");
  require_between("view_angle", view_angle, 0.01, 4, "rad");
  require_between("tracking_tolerance", tracking_tolerance, 1e-4, 0.5, "m");
  catch_up.validate();
}

void ReferenceGenerator::update_plan(const PlannedSkill& planned) {
  plan_ = planned.plan;
  cursor_ = std::min(cursor_, static_cast<double>(plan_->poses.size() - 1));
  if (!planned.forecast || planned.forecast->predictions.empty()) {
    approach_ = Approach();
  } else {
    approach_.update(*plan_, cursor_, planned.stamp, *planned.forecast);
  }
}

void ReferenceGenerator::replace_plan(const PlannedSkill& planned) {
  approach_ = Approach();
  update_plan(planned);
}

void ReferenceGenerator::move_cursor(const ReferenceInput& input) {
  if (!moves_cursor(input.state)) return;
  const auto direction =
      input.state == ExecutionState::kForward ? Direction::kForward : Direction::kBack;
  const auto slowed = std::chrono::duration_cast<Duration>(input.speed * input.since_last_tick);
  const double next = advance_cursor(*plan_, cursor_, direction,
                                     input.speed < 1.0 ? slowed : input.since_last_tick);
  if (!input.follows && (direction == Direction::kForward || leads_away(input, next))) return;
  cursor_ = next;
}

// Whether the set-point would leave behind a hand that does not follow.
bool ReferenceGenerator::leads_away(const ReferenceInput& input, double cursor) const {
  if (!input.hand) return true;
  const auto distance = [&](double at) {
    return (hand_at(*plan_, at, Direction::kStand).pose.position - input.hand->position).norm();
  };
  return !(distance(cursor) <= distance(cursor_));
}

// The target as it is forecast, measured or coasting; without a forecast, where it was last.
void ReferenceGenerator::follow_target(const ReferenceInput& input) {
  if (target_) target_ = at_rest(target_->pose);
  if (!input.forecast) return;
  target_ = predicted_target(*input.forecast, input.stamp + params_.lead).target;
}

bool ReferenceGenerator::is_relative_to_target() const {
  return params_.adaptation == Adaptation::kContinuous && plan_ && target_ &&
         approach_.weight(cursor_, params_.approach_length) > 0;
}

// The view is kept also of a target that is known only as it was last seen.
MovingPose ReferenceGenerator::hand_on_plan(Direction direction) const {
  MovingPose hand = is_relative_to_target()
                        ? approach_.hand(cursor_, direction, *target_, params_.approach_length)
                        : hand_at(*plan_, cursor_, direction);
  if (params_.adaptation == Adaptation::kOnce || !target_) return hand;
  return kept_in_view(hand, setpoint_ ? setpoint_->position : hand.pose.position, *target_,
                      plan_->goal_in_target, params_.view_angle);
}

// What the hand has of the target's velocity is not slowed down.
MovingPose ReferenceGenerator::moving(Direction direction, double speed) const {
  MovingPose hand = hand_on_plan(direction);
  if (speed >= 1.0) return hand;
  const MovingPose standing = hand_on_plan(Direction::kStand);
  const auto slowed = [speed](const Eigen::Vector3d& fast, const Eigen::Vector3d& still) {
    return Eigen::Vector3d(still + speed * (fast - still));
  };
  hand.linear_velocity = slowed(hand.linear_velocity, standing.linear_velocity);
  hand.angular_velocity = slowed(hand.angular_velocity, standing.angular_velocity);
  return hand;
}

std::optional<MovingPose> ReferenceGenerator::reference(const ReferenceInput& input) const {
  if (input.state == ExecutionState::kForward) return moving(Direction::kForward, input.speed);
  if (moves_cursor(input.state)) {
    return moving(cursor_ > 0 ? Direction::kBack : Direction::kStand, input.speed);
  }
  if (input.state == ExecutionState::kPause && is_relative_to_target()) {
    return hand_on_plan(Direction::kStand);
  }
  if (input.look) return at_rest(*input.look);
  if (!tracks(input.state)) return std::nullopt;
  if (params_.adaptation == Adaptation::kOnce) return hand_at(*plan_, cursor_, Direction::kStand);
  if (input.violation || !input.forecast) return std::nullopt;
  return goal_at(*input.forecast, *plan_, input.stamp + params_.lead);
}

ReferenceResult ReferenceGenerator::step(const ReferenceInput& input) {
  move_cursor(input);
  follow_target(input);
  const std::optional<MovingPose> wanted = reference(input);
  const bool begins_anew = holds(input.state) || (input.look && !input.follows) || !setpoint_;
  if (input.hand && begins_anew) setpoint_ = input.hand;
  ReferenceResult result;
  bool tracked = false;
  CatchUpParams catch_up = params_.catch_up;
  catch_up.linear *= input.speed;
  catch_up.angular *= input.speed;
  if (wanted) {
    result.setpoint = setpoint_
                          ? limited_setpoint(*setpoint_, *wanted, catch_up, input.since_last_tick)
                          : *wanted;
    setpoint_ = result.setpoint->pose;
    result.at_start = cursor_ == 0 && input.hand_on_goal &&
                      are_near(*setpoint_, wanted->pose, params_.tracking_tolerance);
    tracked = input.state == ExecutionState::kTracking && input.hand_on_goal &&
              (wanted->pose.position - setpoint_->position).norm() <= params_.tracking_tolerance;
  } else if (!holds(input.state) && setpoint_) {
    result.setpoint = at_rest(*setpoint_);
  }
  if (!tracked) {
    tracked_since_.reset();
  } else if (!tracked_since_) {
    tracked_since_ = input.stamp;
  }
  return result;
}

std::optional<Duration> ReferenceGenerator::tracked_for(Stamp stamp) const {
  if (!tracked_since_) return std::nullopt;
  return stamp - *tracked_since_;
}

bool ReferenceGenerator::is_at_target() const {
  return is_complete() || approach_.weight(cursor_, params_.approach_length) >= 1;
}

bool ReferenceGenerator::is_on_skill(const Pose& hand, const PoseTolerance& tolerance) const {
  return !plan_ || error_between(hand, hand_on_plan(Direction::kStand).pose).is_within(tolerance);
}

std::optional<GoalDistance> ReferenceGenerator::goal_distance(const Pose& hand,
                                                              const TargetForecast& forecast,
                                                              Stamp stamp) const {
  if (!plan_ || forecast.predictions.empty()) return std::nullopt;
  const Pose goal = goal_at(forecast, *plan_, stamp).pose;
  const Eigen::Vector3d offset = hand.position - goal.position;
  const Eigen::Vector3d axis = goal.orientation * Eigen::Vector3d::UnitZ();
  return GoalDistance{offset.norm(), (offset - offset.dot(axis) * axis).norm()};
}

}  // namespace prf_decision
