// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/skill_executive.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <stdexcept>
#include <utility>

#include "sentence.hpp"

namespace prf_decision {
namespace {

using prf_core::require;

constexpr double kLongestTime = 3600;   // s, of an execution
constexpr double kShortestLimit = 0.1;  // s, ten ticks
constexpr double kLongestDwell = 5;     // s, that the HMM's reaction may wait

bool is_finite(const MovingPose& pose) {
  return pose.pose.position.allFinite() && pose.pose.orientation.coeffs().allFinite() &&
         pose.linear_velocity.allFinite() && pose.angular_velocity.allFinite();
}

const DecisionParams& validated(const DecisionParams& params) {
  params.validate();
  return params;
}

}  // namespace

void DecisionParams::validate() const {
  prf_core::require_between("hold_time", to_seconds(hold_time), 0, kLongestTime, "s");
  prf_core::require_between("dwell_time", to_seconds(dwell_time), 0, kLongestDwell, "s");
  prf_core::require_between("time_limit", to_seconds(time_limit), kShortestLimit, kLongestTime,
                            "s");
  reference.validate();
  guards.validate();
  hmm.validate();
  arm.validate();
  search.validate();
}

void SkillGoal::validate() const {
  prf_core::require_between("time_limit", to_seconds(time_limit), 0, kLongestTime, "s");
  prf_core::require_between("hold_time", to_seconds(hold_time), 0, kLongestTime, "s");
  require(!resume || demonstration.empty(), "demonstration", demonstration,
          "empty with resume, which goes on with the one before");
}

SkillExecutive::SkillExecutive(const DecisionParams& params)
    : params_(validated(params)),
      belief_(params.hmm),
      shadow_(params.arm),
      reference_(params.reference) {
  if (params_.autostart) goals_.next = SkillGoal();
}

void SkillExecutive::begin(const SkillGoal& goal) {
  goal.validate();
  if (!can_begin()) throw std::invalid_argument("an execution is under way");
  if (!goal.demonstration.empty()) plans_.demonstration().request(goal.demonstration);
  goals_.next = goal;
  goals_.preempt_requested = false;
}

void SkillExecutive::tune(const DecisionParams& params) {
  params.validate();
  const Adaptation adaptation = params_.reference.adaptation;
  params_ = params;
  params_.reference.adaptation = adaptation;
  reference_.set_params(params_.reference);
}

ExecutiveResult SkillExecutive::update(const Tick& tick) {
  if (!last_tick_) last_tick_ = tick.stamp;
  goals_.refusal.clear();
  // The planner's result is for the last tick: before this one's forecasts.
  if (tick.plan_result) receive_plan(*tick.plan_result);
  belief_.update(tick.forecasts, &shadow_);
  step_shadow(tick);
  following_.update(params_.guards.following, {tick.stamp, last_setpoint_, tick.hand, tick.control,
                                               tick.control_silent, moves_arm()});
  end_unanswered_request(tick.stamp);
  if (goals_.next && !is_requesting()) begin_execution(tick.stamp);
  switch_demonstration();
  const ExecutionState before = fsm_.published_state();
  const Assessment assessment =
      assessor_.assess(params_.guards, params_.dwell_time, belief_, assessment_input(tick));
  change_state(tick, assessment);
  if (fsm_.published_state() != before) begin_search(tick);
  const std::optional<MovingPose> setpoint = move(tick, assessment.violation);
  last_tick_ = tick.stamp;
  last_setpoint_ = setpoint ? std::optional(setpoint->pose) : std::nullopt;
  return {progress(tick), setpoint};
}

bool SkillExecutive::moves_arm() const {
  const ExecutionState state = fsm_.published_state();
  return state != ExecutionState::kWaiting && state != ExecutionState::kStopped &&
         state != ExecutionState::kDone;
}

void SkillExecutive::receive_plan(const PlanResult& result) {
  const ReceiveResult received = plans_.receive(result, belief_.forecast());
  if (received.plan) reference_.update_plan(*received.plan);
  if (received.refusal) {
    goals_.next.reset();
    goals_.refusal = *received.refusal;
  }
}

// The planner does not answer, or the goal was cancelled meanwhile.
void SkillExecutive::end_unanswered_request(Stamp stamp) {
  if (!is_requesting()) return;
  if (plans_.demonstration().is_overdue(stamp)) {
    goals_.refusal = sentence("the planner did not answer within ",
                              to_seconds(DemonstrationSwitch::kPatience), " s");
  }
  if (goals_.preempt_requested) goals_.refusal = "preempted";
  if (goals_.refusal.empty()) return;
  plans_.demonstration().end_request();
  goals_.next.reset();
}

void SkillExecutive::begin_execution(Stamp stamp) {
  goals_.current = *std::exchange(goals_.next, std::nullopt);
  auto& [time_limit, hold_time, resume, demonstration] = goals_.current;
  if (time_limit == Duration{0}) time_limit = params_.time_limit;
  if (hold_time == Duration{0}) hold_time = params_.hold_time;
  goals_.began = stamp;
  const bool leaves_start = !resume && reference_.cursor() > 0;
  fsm_.begin(stamp, leaves_start || plans_.demonstration().is_returning());
}

// At the start of the skill before, once an execution has led there and a plan has come.
void SkillExecutive::switch_demonstration() {
  if (fsm_.state() == State::kIdle || reference_.cursor() > 0) return;
  if (const auto planned = plans_.arrive()) reference_.replace_plan(*planned);
}

// From the start of the skill, whose hand stands there: it must not move toward a target that it
// does not see.
bool SkillExecutive::can_search(const Tick& tick) const {
  const Trajectory* plan = reference_.plan();
  const auto& last = belief_.forecast();
  if (adapts_once() || params_.search.time == Duration{0} || !plan || !tick.hand) return false;
  if (reference_.cursor() > 0 || following_.is_off() || !last || last->predictions.empty()) {
    return false;
  }
  return reference_.is_on_skill(*tick.hand, {params_.guards.following.path.position, 2 * M_PI});
}

// Around where the target is forecast now; beyond the forecast's reach, where it ends. From where
// the plan begins, drawn back where the hand is farther from the target already.
void SkillExecutive::begin_search(const Tick& tick) {
  if (fsm_.state() != State::kSearch) return;
  const Trajectory& plan = *reference_.plan();
  const auto last = predicted_target(*belief_.forecast(), tick.stamp + params_.reference.lead);
  const auto from_target = [&](const Pose& hand) -> Eigen::Vector3d {
    return hand.position - last.target.pose.position;
  };
  Pose stand = plan.poses.front();
  const double farther = from_target(*tick.hand).norm() - from_target(stand).norm();
  const double back = std::clamp(farther, 0.0, params_.guards.following.path.position);
  stand.position += back * from_target(stand).normalized();
  search_.begin(stand, plan.goal_in_target, last);
}

std::optional<Pose> SkillExecutive::look(const Tick& tick) {
  if (fsm_.state() != State::kSearch) return std::nullopt;
  return search_.look(params_.search, {tick.stamp, tick.hand, tick.joints, !following_.is_off()});
}

GuardInput SkillExecutive::guard_input(const Tick& tick) const {
  GuardInput input;
  input.tick = tick.stamp;
  input.goal_time = tick.stamp + params_.reference.lead;
  input.since_last_tick = tick.stamp - *last_tick_;
  input.following = &following_;
  input.has_goal = fsm_.state() != State::kIdle;
  input.measured = belief_.measured();
  input.forecast = belief_.forecast().get();
  input.forecast_silent = tick.forecast_silent;
  input.plan = plans_.demonstration().is_returning() ? plans_.next_plan() : reference_.plan();
  input.no_plan = plans_.no_plan();
  input.planner_silent = tick.planner_silent;
  if (reference_.cursor() == 0) input.holdable = shadow_.holdable();
  return input;
}

AssessmentInput SkillExecutive::assessment_input(const Tick& tick) const {
  AssessmentInput input;
  input.guards = guard_input(tick);
  input.state = fsm_.state();
  input.adapted_once = adapts_once();
  input.at_start = reference_.cursor() == 0;
  input.at_target = reference_.is_at_target();
  input.away = tick.hand && !reference_.is_on_skill(*tick.hand, params_.guards.following.path);
  input.can_search = can_search(tick);
  input.search_time = params_.search.time;
  input.search_width = search_.width();
  return input;
}

// At most one change per tick: the first event, in this order, that has a row.
void SkillExecutive::change_state(const Tick& tick, const Assessment& assessment) {
  const auto fire = [&](Event event, const std::string& reason) {
    return fsm_.fire(tick.stamp, event, reason, params_.dwell_time);
  };
  if (std::exchange(goals_.preempt_requested, false) && fire(Event::kPreempted, "preempted")) {
    return;
  }
  std::string reason = assessment.reason;
  if (reason.empty() && fsm_.state() == State::kTracking && !following_.is_on_goal()) {
    const PoseError error = following_.error().value_or(PoseError());
    reason = sentence("the hand is ", error.position, " m and ", error.rotation,
                      " rad from its set-point");
  }
  const Duration elapsed = tick.stamp - goals_.began;
  const Duration limit = goals_.current.time_limit;
  if (elapsed > limit && fire(Event::kTimeUp, sentence("not done within ", to_seconds(limit), " s",
                                                       reason.empty() ? "" : ": ", reason))) {
    return;
  }
  // Beside a hazard the HMM may be the more cautious one.
  if (assessment.event == Event::kHazard && !assessment.unstable.empty() &&
      fire(Event::kUnstable, assessment.unstable)) {
    return;
  }
  if (fire(assessment.event, reason)) return;
  if (reference_.is_complete() &&
      fire(Event::kComplete, sentence("skill complete after ", to_seconds(elapsed), " s"))) {
    return;
  }
  const Duration hold_time = goals_.current.hold_time;
  const auto tracked_for = reference_.tracked_for(tick.stamp);
  if (tracked_for && *tracked_for >= hold_time &&
      fire(Event::kHeld, sentence("tracked for ", to_seconds(hold_time), " s"))) {
    return;
  }
  fsm_.explain(reason);
}

// The newest forecast if the hand may follow it on the approach, which a wrong one must not lead.
// Also while no newer one comes: as far as it reaches it is nearer to the target than where the
// target was.
const TargetForecast* SkillExecutive::followed_forecast(const Tick& tick) const {
  const GuardInput input = guard_input(tick);
  const bool usable = input.forecast && !input.forecast->predictions.empty() &&
                      !check_status(params_.guards, input) &&
                      !check_forecast(params_.guards, input);
  return usable ? input.forecast : nullptr;
}

void SkillExecutive::step_shadow(const Tick& tick) {
  if (adapts_once()) return;
  if (const Trajectory* plan = reference_.plan()) shadow_.set_goal(plan->goal_in_target);
  shadow_.step(tick.stamp, tick.stamp - *last_tick_, params_.reference.lead,
               followed_forecast(tick), tick.joints);
}

std::optional<MovingPose> SkillExecutive::move(const Tick& tick, bool violation) {
  const ReferenceResult result =
      reference_.step({tick.stamp, tick.stamp - *last_tick_, fsm_.published_state(), tick.hand,
                       followed_forecast(tick), violation, !following_.is_off(),
                       following_.is_on_goal(), look(tick), speed_.at(tick.stamp)});
  if (result.at_start && !plans_.demonstration().is_returning()) {
    fsm_.fire(tick.stamp, Event::kAtStart, "", params_.dwell_time);
  }
  if (result.setpoint && !is_finite(*result.setpoint)) return std::nullopt;
  return result.setpoint;
}

Progress SkillExecutive::progress(const Tick& tick) const {
  Progress progress;
  progress.stamp = tick.stamp;
  progress.following = following_.error();
  progress.holdable = shadow_.holdable();
  progress.state = fsm_.published_state();
  progress.cause = fsm_.cause();
  progress.reason = fsm_.reason();
  progress.posterior = adapts_once() ? Eigen::Vector3d::UnitX() : belief_.posterior();
  progress.cursor = reference_.cursor();
  progress.demonstration = plans_.demonstration().wanted();
  progress.refusal = goals_.refusal;
  const Trajectory* plan = reference_.plan();
  if (plan) progress.fraction = progress.cursor / static_cast<double>(plan->poses.size() - 1);
  if (plans_.demonstration().state() != SwitchState::kSettled) {
    if (plans_.next_plan()) progress.time_to_go = plans_.next_plan()->times.back();
  } else if (plan) {
    progress.frozen = frozen_nodes(*plan, progress.cursor);
    progress.time_to_go = time_to_go(*plan, progress.cursor);
  }
  if (const auto& forecast = belief_.forecast()) {
    progress.forecast_stamp = forecast->stamp;
    if (tick.hand) {
      progress.goal_distance = reference_.goal_distance(*tick.hand, *forecast, tick.stamp);
    }
  }
  return progress;
}

std::string SkillExecutive::describe() const {
  return sentence(fsm_.describe(), "; demonstration ", name(plans_.demonstration().state()),
                  "; cursor ", reference_.cursor(), goals_.next ? "; a goal waits" : "");
}

}  // namespace prf_decision
