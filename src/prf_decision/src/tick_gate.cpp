// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/tick_gate.hpp"

#include <algorithm>
#include <prf_core/require.hpp>
#include <utility>

namespace prf_decision {
namespace {

using prf_core::StampOrder;
using std::chrono::milliseconds;

constexpr Duration kPeriodMargin = milliseconds(5);  // jitter of the camera's stamps

const GateParams& validated(const GateParams& params) {
  params.validate();
  return params;
}

}  // namespace

void GateParams::validate() const {
  using prf_core::require_between;
  require_between("pipeline_delay", to_seconds(pipeline_delay), 1e-3, 1, "s");
  require_between("camera_period", to_seconds(camera_period), 6e-3, 1, "s");
  require_between("control_delay", to_seconds(control_delay), 0.01, 1, "s");
  require_between("max_wait", to_seconds(max_wait), 0.05, 10, "s");
}

TickGate::TickGate(const GateParams& params)
    : params_(validated(params)),
      forecast_silence_(params.max_wait),
      plan_silence_(params.max_wait),
      control_silence_(params.max_wait) {}

void TickGate::begin_new_run() { *this = TickGate(params_); }

// Forecasts may arrive before the first tick; those of another run are dropped in either order.
void TickGate::begin_at(Stamp first_tick) {
  first_tick_ = first_tick;
  forecasts_.drop_before(first_tick - kPeriodMargin);
  forecasts_.drop_after(first_tick + kClockJump);
  const auto& left = forecasts_.items();
  forecasts_.clock().restart(left.empty() ? std::nullopt : std::optional(left.back().stamp));
}

PushResult TickGate::push_tick(Stamp stamp, const std::optional<Pose>& hand,
                               const std::optional<arm_kinematics::JointVector>& joints) {
  const bool new_run = ticks_.clock().classify(stamp) == StampOrder::kBackwardJump;
  if (new_run) begin_new_run();
  const StampOrder order = ticks_.push(stamp, {hand, joints});
  if (order == StampOrder::kFarAhead) return PushResult::kFarAhead;
  if (!prf_core::is_accepted(order)) return PushResult::kOld;
  if (!first_tick_) begin_at(stamp);
  return new_run ? PushResult::kNewRun : PushResult::kAccepted;
}

PushResult TickGate::push_forecast(ForecastArrival arrival) {
  const Stamp stamp = arrival.stamp;
  if (is_ahead_by(kClockJump, stamp)) return PushResult::kFarAhead;
  if (precedes_run(stamp)) return PushResult::kOld;
  const StampOrder order = forecasts_.push(stamp, std::move(arrival));
  if (order == StampOrder::kFarAhead) return PushResult::kFarAhead;
  if (!prf_core::is_accepted(order)) return PushResult::kOld;
  forecast_silence_.heard();
  return PushResult::kAccepted;
}

PushResult TickGate::push_plan_result(PlanResult result) {
  const Stamp stamp = result.stamp;
  // A result follows its progress, and that its tick: without one it belongs to another run.
  if (!first_tick_ || stamp < *first_tick_) return PushResult::kOld;
  if (is_ahead_by(kMostLead, stamp)) return PushResult::kFarAhead;
  if (!prf_core::is_accepted(plan_results_.push(stamp, std::move(result)))) return PushResult::kOld;
  plan_silence_.heard();
  return PushResult::kAccepted;
}

PushResult TickGate::push_control_report(ControlReport report) {
  const Stamp stamp = report.stamp;
  // A report follows its tick, as a plan does.
  if (!first_tick_ || stamp < *first_tick_) return PushResult::kOld;
  if (is_ahead_by(kMostLead, stamp)) return PushResult::kFarAhead;
  if (!prf_core::is_accepted(control_reports_.push(stamp, std::move(report)))) {
    return PushResult::kOld;
  }
  control_silence_.heard();
  return PushResult::kAccepted;
}

bool TickGate::is_ahead_by(Duration lead, Stamp stamp) const {
  const auto newest = ticks_.clock().newest();
  return newest && stamp > *newest + lead;
}

bool TickGate::precedes_run(Stamp forecast) const {
  return first_tick_ && forecast < *first_tick_ - kPeriodMargin;
}

bool TickGate::forecast_may_be_due(Stamp tick) const {
  const Stamp before_run = *first_tick_ - params_.camera_period;
  const Stamp newest = std::max(forecasts_.clock().newest().value_or(before_run), before_run);
  return tick - params_.pipeline_delay >= newest + params_.camera_period - kPeriodMargin;
}

bool TickGate::plan_result_is_due() const {
  const auto newest = plan_results_.clock().newest();
  return awaited_plan_result_ && (!newest || *newest < *awaited_plan_result_);
}

bool TickGate::control_report_is_due(Stamp tick) const {
  const Stamp due = tick - params_.control_delay;
  const auto newest = control_reports_.clock().newest();
  return due >= *first_tick_ && (!newest || *newest < due);
}

std::optional<Tick> TickGate::next() {
  if (ticks_.items().empty()) return std::nullopt;
  Tick tick;
  tick.stamp = ticks_.items().front().stamp;
  const Stamp newest = *ticks_.clock().newest();
  // All are evaluated: each monitor must learn of its own silence.
  const bool waits_for_forecast =
      forecast_may_be_due(tick.stamp) && !forecast_silence_.gives_up(tick.stamp, newest);
  const bool waits_for_plan = plan_result_is_due() && !plan_silence_.gives_up(tick.stamp, newest);
  const bool waits_for_report =
      control_report_is_due(tick.stamp) && !control_silence_.gives_up(tick.stamp, newest);
  if (waits_for_forecast || waits_for_plan || waits_for_report) return std::nullopt;

  const MeasuredArm measured = ticks_.pop_until(tick.stamp)->message;
  tick.hand = measured.hand;
  tick.joints = measured.joints;
  while (auto forecast = forecasts_.pop_until(tick.stamp - params_.pipeline_delay)) {
    tick.forecasts.push_back(std::move(forecast->message));
  }
  while (auto result = plan_results_.pop_until(tick.stamp - Duration{1})) {
    tick.plan_result = std::move(result->message);
  }
  while (auto report = control_reports_.pop_until(tick.stamp - params_.control_delay)) {
    control_ = std::move(report->message);
  }
  tick.control = control_;
  const bool named = std::any_of(tick.forecasts.begin(), tick.forecasts.end(),
                                 [](const ForecastArrival& arrival) { return arrival.forecast; });
  if (named) awaited_plan_result_ = tick.stamp;
  tick.forecast_silent = forecast_silence_.is_silent();
  tick.planner_silent = plan_silence_.is_silent();
  tick.control_silent = control_silence_.is_silent();
  return tick;
}

}  // namespace prf_decision
