// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/decision.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <utility>

#include "text.hpp"

namespace prf_decision {
namespace {

using prf_core::require;

Objection hazard(std::string reason) { return {Event::kHazard, std::move(reason)}; }

Event event_of(Intent intent) {
  switch (intent) {
    case Intent::kForward:
      return Event::kCalm;
    case Intent::kPause:
      return Event::kUnsteady;
    case Intent::kReverse:
      break;
  }
  return Event::kUnstable;
}

bool acts_on_plan(State state) {
  return state == State::kForward || state == State::kReverse || state == State::kRetract;
}

MovingPose goal_at(const TargetForecast& forecast, const Trajectory& plan, Stamp stamp) {
  return prf_core::rigidly_attached(predicted_target(forecast, stamp).target, plan.goal_in_target);
}

bool are_near(const Pose& a, const Pose& b, double distance) {
  constexpr double kAngle = 0.05;  // rad
  return (a.position - b.position).norm() <= distance &&
         a.orientation.angularDistance(b.orientation) <= kAngle;
}

bool follows_target(State state) { return state == State::kTracking || state == State::kDone; }

// States whose reason is what the assessment says now, not what led into them.
bool explains_itself(State state) {
  return state == State::kWaiting || state == State::kPause || state == State::kReverse ||
         state == State::kRetract;
}

}  // namespace

void DecisionParams::validate() const {
  require(max_gap > Duration{0}, "max_wait", to_seconds(max_gap), "> 0 s");
  require(lead >= Duration{0}, "lead", to_seconds(lead), ">= 0 s");
  require(hold_time >= Duration{0}, "hold_time", to_seconds(hold_time), ">= 0 s");
  require(dwell_time >= Duration{0}, "dwell_time", to_seconds(dwell_time), ">= 0 s");
  require(time_limit > Duration{0}, "time_limit", to_seconds(time_limit), "> 0 s");
  require(tracking_tolerance > 0 && std::isfinite(tracking_tolerance), "tracking_tolerance",
          tracking_tolerance, "> 0 m and finite");
  require(approach_length >= 0 && std::isfinite(approach_length), "approach_length",
          approach_length, ">= 0 m and finite");
  catch_up.validate();
  guards.validate();
  hmm.validate();
}

void Order::validate() const {
  require(time_limit >= Duration{0}, "time_limit", to_seconds(time_limit), ">= 0 s");
  require(hold_time >= Duration{0}, "hold_time", to_seconds(hold_time), ">= 0 s");
  require(!resume || demonstration.empty(), "demonstration", demonstration,
          "empty with resume, which goes on with the one before");
}

Decision::Decision(const DecisionParams& parameters)
    : parameters_((parameters.validate(), parameters)),
      hmm_(parameters.hmm),
      belief_(hmm_.initial_belief()) {
  if (parameters_.autostart) order_ = Order();
}

bool Decision::can_begin() const {
  const bool ended = state_ == State::kDone || state_ == State::kStopped;
  return !order_ && (!execution_ || ended);
}

void Decision::begin(const Order& order) {
  order.validate();
  if (!can_begin()) throw std::invalid_argument("an execution is under way");
  if (!order.demonstration.empty()) demonstration_switch_.ask(order.demonstration);
  order_ = order;
  preempted_ = false;
}

void Decision::tune(const DecisionParams& parameters) {
  parameters.validate();
  const bool framework = parameters_.framework;
  parameters_ = parameters;
  parameters_.framework = framework;
}

void Decision::begin_execution(Stamp stamp) {
  execution_ = order_;
  if (execution_->time_limit == Duration{0}) execution_->time_limit = parameters_.time_limit;
  if (execution_->hold_time == Duration{0}) execution_->hold_time = parameters_.hold_time;
  order_.reset();
  begun_ = entered_ = stamp;
  state_ = State::kWaiting;
  cause_ = Event::kCalm;
  reason_.clear();
  tracked_since_.reset();
  rewinding_ = (!execution_->resume && cursor_ > 0) || demonstration_switch_.is_taking_over();
}

Outcome Decision::update(const Tick& tick) {
  if (!last_tick_) last_tick_ = tick.stamp;
  refusal_.clear();
  take_in(tick);
  stop_asking(tick.stamp);
  if (order_ && !demonstration_switch_.is_asking()) begin_execution(tick.stamp);
  take_over_when_at_the_start();
  const Assessment assessment = assess(tick);
  change_state(tick, assessment);
  const std::optional<MovingPose> setpoint = move(tick, assessment.objected);
  last_tick_ = tick.stamp;
  return {report(tick.stamp), setpoint};
}

void Decision::take_in(const Tick& tick) {
  // The answer is to the last tick: before this one's forecasts.
  if (tick.answer) take_answer(*tick.answer);
  for (const auto& [stamp, forecast] : tick.forecasts) {
    const bool tracked = forecast && forecast->status == TargetStatus::kTracking;
    belief_ = tracked ? hmm_.observe(belief_, forecast->predictions[0].target.linear_velocity)
                      : hmm_.predict(belief_);
    if (!forecast) continue;
    forecast_ = forecast;
    if (forecast->status != TargetStatus::kNoTarget) {
      const Stamp seen = stamp - forecast->since_measurement;
      last_seen_ = std::max(last_seen_.value_or(seen), seen);
    }
  }
}

void Decision::take_answer(const PlanAnswer& answer) {
  switch (demonstration_switch_.take(answer.demonstration_switch, answer.refused)) {
    case Reply::kOfAnother:
      return;
    case Reply::kRefused:
      order_.reset();
      refusal_ = answer.message;
      return;
    case Reply::kTakenUp:
      next_ = {};
      break;
    case Reply::kPlan:
      break;
  }
  plan_refusal_.reset();
  if (!answer.plan) {
    plan_refusal_ = answer.message;
    return;
  }
  const Planned planned{answer.plan, answer.stamp, forecast_};
  if (demonstration_switch_.is_taking_over()) {
    next_ = planned;
  } else {
    adopt(planned);
  }
}

void Decision::adopt(const Planned& planned) {
  plan_ = planned.plan;
  cursor_ = std::min(cursor_, static_cast<double>(plan_->poses.size() - 1));
  if (!planned.forecast || planned.forecast->predictions.empty()) {
    approach_ = Approach();
  } else {
    approach_.take(*plan_, cursor_, planned.stamp, *planned.forecast);
  }
}

void Decision::take_over_when_at_the_start() {
  if (!demonstration_switch_.is_taking_over() || !execution_ || cursor_ > 0 || !next_.plan) return;
  demonstration_switch_.come_into_force();
  approach_ = Approach();
  adopt(std::exchange(next_, {}));
}

// The planner does not answer, or whoever asked does not want it any more.
void Decision::stop_asking(Stamp stamp) {
  if (!demonstration_switch_.is_asking()) return;
  if (demonstration_switch_.is_overdue(stamp)) {
    refusal_ = sentence("the planner did not answer within ",
                        to_seconds(DemonstrationSwitch::kPatience), " s");
  }
  if (preempted_) refusal_ = "preempted";
  if (refusal_.empty()) return;
  demonstration_switch_.withdraw();
  order_.reset();
}

const std::shared_ptr<const Trajectory>& Decision::newest_plan() const {
  return demonstration_switch_.is_taking_over() ? next_.plan : plan_;
}

std::optional<Objection> Decision::object_to_target(const Tick& tick) const {
  if (!last_seen_) return hazard("target not seen yet");
  if (const auto objection = object_to_age(parameters_.guards, tick.stamp - *last_seen_)) {
    return objection;
  }
  if (tick.forecast_stale) {
    return hazard(
        sentence("forecast silent for ", to_seconds(tick.stamp - forecast_->stamp), " s"));
  }
  if (forecast_->status == TargetStatus::kNoTarget || forecast_->status == TargetStatus::kLost) {
    return hazard("predictor has lost the target");
  }
  return object_to_forecast(parameters_.guards, *forecast_);
}

std::optional<Objection> Decision::object(const Tick& tick) const {
  if (!execution_) return hazard("no goal yet");
  const Duration gap = tick.stamp - *last_tick_;
  if (gap > parameters_.max_gap) {
    return hazard(sentence("joint_states silent for ", to_seconds(gap), " s"));
  }
  if (parameters_.framework) {
    if (const auto objection = object_to_target(tick)) return objection;
  }
  const auto& plan = newest_plan();
  if (!plan) return hazard("no plan yet" + (plan_refusal_ ? ": " + *plan_refusal_ : ""));
  if (!parameters_.framework) return std::nullopt;
  if (tick.plan_stale) return hazard("planner silent");
  if (plan_refusal_) return hazard("planner has no plan: " + *plan_refusal_);
  return object_to_goal(parameters_.guards,
                        goal_at(*forecast_, *plan, tick.stamp + parameters_.lead).pose);
}

Decision::Assessment Decision::assess(const Tick& tick) const {
  if (const auto objection = object(tick)) return {objection->event, objection->reason, true};
  if (rewinding_) return {Event::kRewind, "back to the start of the skill", false};
  if (!parameters_.framework) return {Event::kCalm, "", false};
  const Intent intent = most_probable(belief_);
  if (intent == Intent::kForward) return {Event::kCalm, "", false};
  const auto index = static_cast<std::size_t>(intent);
  const double speed = forecast_->predictions[0].target.linear_velocity.norm();
  return {event_of(intent),
          sentence("belief in ", kIntentNames[index], " ",
                   belief_.posterior[static_cast<Eigen::Index>(index)], ", target speed ", speed,
                   " m/s"),
          false};
}

bool Decision::try_event(Stamp stamp, Event event, const std::string& reason) {
  const bool dwelled = stamp - entered_ >= parameters_.dwell_time;
  const State next = step(state_, event, dwelled);
  if (next == state_) return false;
  state_ = next;
  cause_ = event;
  entered_ = stamp;
  reason_ = reason;
  return true;
}

// At most one change per tick: the first event, in this order, that has a row.
void Decision::change_state(const Tick& tick, const Assessment& assessment) {
  const bool preempted = std::exchange(preempted_, false);
  if (!execution_) {
    reason_ = assessment.reason;
    return;
  }
  if (preempted && try_event(tick.stamp, Event::kPreempted, "preempted")) return;
  const Duration elapsed = tick.stamp - begun_;
  if (elapsed > execution_->time_limit &&
      try_event(tick.stamp, Event::kTimeUp,
                sentence("not done within ", to_seconds(execution_->time_limit), " s",
                         assessment.reason.empty() ? "" : ": ", assessment.reason))) {
    return;
  }
  if (try_event(tick.stamp, assessment.event, assessment.reason)) return;
  if (plan_ && at_end(*plan_, cursor_) &&
      try_event(tick.stamp, Event::kComplete,
                sentence("skill complete after ", to_seconds(elapsed), " s"))) {
    return;
  }
  const bool held = tracked_since_ && tick.stamp - *tracked_since_ >= execution_->hold_time;
  if (held && try_event(tick.stamp, Event::kHeld,
                        sentence("tracked for ", to_seconds(execution_->hold_time), " s"))) {
    return;
  }
  if (explains_itself(state_) && !assessment.reason.empty()) reason_ = assessment.reason;
}

// The target as far as it can be followed, whether seen or coasting; then where it was last.
void Decision::follow_target(const Tick& tick) {
  if (approached_) approached_ = {approached_->pose, {0, 0, 0}, {0, 0, 0}};
  if (!forecast_ || tick.forecast_stale || forecast_->predictions.empty()) return;
  const TargetStatus status = forecast_->status;
  if (status != TargetStatus::kTracking && status != TargetStatus::kCoasting) return;
  if (object_to_forecast(parameters_.guards, *forecast_)) return;
  approached_ = predicted_target(*forecast_, tick.stamp + parameters_.lead).target;
}

bool Decision::is_bound_to_target() const {
  return parameters_.framework && plan_ && approached_ &&
         approach_.share(cursor_, parameters_.approach_length) > 0;
}

MovingPose Decision::hand_on_plan(Direction direction) const {
  return is_bound_to_target()
             ? approach_.hand(cursor_, direction, *approached_, parameters_.approach_length)
             : hand_at(*plan_, cursor_, direction);
}

std::optional<MovingPose> Decision::reference(Stamp stamp, bool objected) const {
  if (state_ == State::kForward) return hand_on_plan(Direction::kForward);
  if (acts_on_plan(state_)) {
    return hand_on_plan(cursor_ > 0 ? Direction::kBack : Direction::kStand);
  }
  if (state_ == State::kPause && is_bound_to_target()) return hand_on_plan(Direction::kStand);
  if (!follows_target(state_)) return std::nullopt;
  if (!parameters_.framework) return hand_at(*plan_, cursor_, Direction::kStand);
  if (objected) return std::nullopt;
  return goal_at(*forecast_, *plan_, stamp + parameters_.lead);
}

std::optional<MovingPose> Decision::move(const Tick& tick, bool objected) {
  const Duration dt = tick.stamp - *last_tick_;
  if (acts_on_plan(state_)) {
    const auto direction = state_ == State::kForward ? Direction::kForward : Direction::kBack;
    cursor_ = advance_cursor(*plan_, cursor_, direction, dt);
  }
  follow_target(tick);
  const std::optional<MovingPose> wanted = reference(tick.stamp, objected);
  const bool holds = state_ == State::kWaiting || state_ == State::kStopped;
  // The arm stands where it stopped, or was left by a decision before this one.
  if (tick.hand && (holds || !setpoint_)) setpoint_ = tick.hand;
  std::optional<MovingPose> setpoint;
  if (wanted) {
    setpoint =
        setpoint_ ? limited_setpoint(*setpoint_, *wanted, parameters_.catch_up, dt) : *wanted;
    setpoint_ = setpoint->pose;
    const bool at_start = cursor_ == 0 && !demonstration_switch_.is_taking_over() &&
                          are_near(*setpoint_, wanted->pose, parameters_.tracking_tolerance);
    rewinding_ = rewinding_ && !at_start;
  } else if (!holds && setpoint_) {
    setpoint = MovingPose{*setpoint_, {0, 0, 0}, {0, 0, 0}};
  }

  const bool tracked =
      wanted && state_ == State::kTracking &&
      (wanted->pose.position - setpoint->pose.position).norm() <= parameters_.tracking_tolerance;
  if (!tracked) {
    tracked_since_.reset();
  } else if (!tracked_since_) {
    tracked_since_ = tick.stamp;
  }
  return setpoint;
}

Progress Decision::report(Stamp stamp) const {
  Progress progress;
  progress.stamp = stamp;
  if (forecast_) progress.forecast_stamp = forecast_->stamp;
  progress.state = state_;
  progress.reason = reason_;
  progress.posterior = parameters_.framework ? belief_.posterior : Eigen::Vector3d::UnitX();
  progress.cause = cause_;
  progress.cursor = cursor_;
  progress.demonstration = demonstration_switch_.wanted();
  progress.refusal = refusal_;
  if (plan_) progress.share = cursor_ / static_cast<double>(plan_->poses.size() - 1);
  if (demonstration_switch_.is_asking() || demonstration_switch_.is_taking_over()) {
    if (next_.plan) progress.time_to_go = next_.plan->times.back();
  } else if (plan_) {
    progress.frozen = frozen_nodes(*plan_, cursor_);
    progress.time_to_go = time_to_go(*plan_, cursor_);
  }
  if (plan_ && setpoint_ && forecast_ && !forecast_->predictions.empty()) {
    const Pose goal = goal_at(*forecast_, *plan_, stamp).pose;
    const Eigen::Vector3d offset = setpoint_->position - goal.position;
    const Eigen::Vector3d axis = goal.orientation * Eigen::Vector3d::UnitZ();
    progress.goal_distance = offset.norm();
    progress.axis_distance = (offset - offset.dot(axis) * axis).norm();
  }
  return progress;
}

}  // namespace prf_decision
