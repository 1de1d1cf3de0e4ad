// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/belief_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace prf_decision {

std::optional<ObservedMotion> observation_of(const TargetForecast& forecast) {
  const prf_core::MeasuredMotion& measured = forecast.measured_motion;
  const bool tracked = forecast.status == TargetStatus::kTracking && !forecast.predictions.empty();
  if (!tracked && !measured.has_velocity()) return std::nullopt;
  ObservedMotion observation;
  observation.velocity =
      tracked ? forecast.predictions[0].target.linear_velocity : measured.velocity;
  double square = measured.speed * measured.speed;
  if (measured.has_velocity()) {
    square =
        std::max(square, measured.velocity.squaredNorm() - measured.velocity_covariance.trace());
  }
  const double hidden = square - observation.velocity.squaredNorm();
  // Bounded before the root: a square may have overflown, and the difference may be no number.
  observation.spread = hidden <= 0 ? 0
                                   : std::sqrt(std::min(kMaxObservedSpeed * kMaxObservedSpeed,
                                                        std::isnan(hidden) ? HUGE_VAL : hidden));
  return observation;
}

BeliefTracker::BeliefTracker(const HmmParams& params)
    : hmm_(params), belief_(hmm_.initial_belief()) {}

void BeliefTracker::update(const std::vector<ForecastArrival>& forecasts) {
  for (const auto& [stamp, forecast] : forecasts) {
    const auto observed = forecast ? observation_of(*forecast) : std::nullopt;
    const bool was_reset = belief_.was_reset;
    if (observed) speed_ = std::hypot(observed->velocity.stableNorm(), observed->spread);
    belief_ = observed ? hmm_.observe(belief_, *observed) : hmm_.predict(belief_);
    if (belief_.was_reset && !was_reset) ++resets_;
    if (!forecast) continue;
    forecast_ = forecast;
    if (forecast->status == TargetStatus::kNoTarget) continue;
    const Stamp measured = stamp - forecast->since_measurement;
    measured_ = std::max(measured_.value_or(measured), measured);
  }
}

}  // namespace prf_decision
