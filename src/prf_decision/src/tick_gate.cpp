// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/tick_gate.hpp"

#include <algorithm>
#include <prf_core/require.hpp>
#include <utility>

namespace prf_decision {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kPeriodMargin = milliseconds(5);  // jitter of the camera's stamps
constexpr Duration kClockJump = seconds(1);          // larger steps are another run or garbage
constexpr std::size_t kMaxQueued = 1000;             // forecasts and answers without any tick

template <typename Item>
void enqueue(std::deque<Item>& queue, Item item) {
  queue.push_back(std::move(item));
  if (queue.size() > kMaxQueued) queue.pop_front();
}

}  // namespace

void GateParams::validate() const {
  using prf_core::require_positive;
  require_positive("pipeline_delay", to_seconds(pipeline_delay), "s");
  require_positive("camera_period less 5 ms", to_seconds(camera_period - kPeriodMargin), "s");
  require_positive("max_wait", to_seconds(max_wait), "s");
}

TickGate::TickGate(const GateParams& parameters) : parameters_(parameters) {
  parameters_.validate();
}

void TickGate::begin_new_run() { *this = TickGate(parameters_); }

// Forecasts may arrive before the first tick; those of another run are dropped in either order.
void TickGate::begin_at(Stamp first_tick) {
  first_tick_ = first_tick;
  const auto foreign = [&](const ForecastArrival& arrival) {
    return precedes_run(arrival.stamp) || arrival.stamp > first_tick + kClockJump;
  };
  forecasts_.erase(std::remove_if(forecasts_.begin(), forecasts_.end(), foreign), forecasts_.end());
  newest_forecast_.reset();
  if (!forecasts_.empty()) newest_forecast_ = forecasts_.back().stamp;
}

Push TickGate::push_tick(Stamp stamp, const std::optional<Pose>& hand) {
  if (newest_tick_ == stamp) return Push::kOld;
  const bool new_run = newest_tick_ && stamp < *newest_tick_;
  if (new_run) begin_new_run();
  newest_tick_ = stamp;
  if (!first_tick_) begin_at(stamp);
  ticks_.push_back({stamp, hand});
  return new_run ? Push::kNewRun : Push::kTaken;
}

Push TickGate::push_forecast(ForecastArrival arrival) {
  if (newest_tick_ && arrival.stamp > *newest_tick_ + kClockJump) return Push::kFuture;
  const std::optional<Stamp> known = newest_forecast_ ? newest_forecast_ : first_tick_;
  const bool new_run = known && arrival.stamp < *known - kClockJump;
  if (new_run) begin_new_run();
  if (newest_forecast_ && arrival.stamp <= *newest_forecast_) return Push::kOld;
  if (precedes_run(arrival.stamp)) return Push::kOld;
  newest_forecast_ = arrival.stamp;
  forecast_stale_ = false;
  enqueue(forecasts_, std::move(arrival));
  return new_run ? Push::kNewRun : Push::kTaken;
}

Push TickGate::push_answer(PlanAnswer answer) {
  // An answer follows its progress, and that its tick: without one it belongs to another run.
  if (!first_tick_ || answer.stamp < *first_tick_) return Push::kOld;
  if (answer.stamp > *newest_tick_ + kClockJump) return Push::kFuture;
  if (newest_answer_ && answer.stamp <= *newest_answer_) return Push::kOld;
  newest_answer_ = answer.stamp;
  plan_stale_ = false;
  enqueue(answers_, std::move(answer));
  return Push::kTaken;
}

bool TickGate::precedes_run(Stamp forecast) const {
  return first_tick_ && forecast < *first_tick_ - kPeriodMargin;
}

bool TickGate::forecast_may_be_due(Stamp tick) const {
  const Stamp before_run = *first_tick_ - parameters_.camera_period;
  const Stamp newest = std::max(newest_forecast_.value_or(before_run), before_run);
  return tick - parameters_.pipeline_delay >= newest + parameters_.camera_period - kPeriodMargin;
}

bool TickGate::answer_is_due() const {
  return awaited_answer_ && (!newest_answer_ || *newest_answer_ < *awaited_answer_);
}

std::optional<Tick> TickGate::next() {
  if (ticks_.empty()) return std::nullopt;
  Tick tick;
  tick.stamp = ticks_.front().stamp;
  tick.hand = ticks_.front().hand;
  const bool forecast_missing = !forecast_stale_ && forecast_may_be_due(tick.stamp);
  const bool answer_missing = !plan_stale_ && answer_is_due();
  if (forecast_missing || answer_missing) {
    if (*newest_tick_ - tick.stamp <= parameters_.max_wait) return std::nullopt;
    forecast_stale_ = forecast_stale_ || forecast_missing;
    plan_stale_ = plan_stale_ || answer_missing;
  }
  ticks_.pop_front();

  while (!forecasts_.empty() &&
         forecasts_.front().stamp <= tick.stamp - parameters_.pipeline_delay) {
    tick.forecasts.push_back(std::move(forecasts_.front()));
    forecasts_.pop_front();
  }
  while (!answers_.empty() && answers_.front().stamp < tick.stamp) {
    tick.answer = std::move(answers_.front());
    answers_.pop_front();
  }
  const bool named = std::any_of(tick.forecasts.begin(), tick.forecasts.end(),
                                 [](const ForecastArrival& arrival) { return arrival.forecast; });
  if (named) awaited_answer_ = tick.stamp;
  tick.forecast_stale = forecast_stale_;
  tick.plan_stale = plan_stale_;
  return tick;
}

}  // namespace prf_decision
