// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/belief_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace prf_decision {

BeliefTracker::BeliefTracker(const HmmParams& params)
    : hmm_(params), belief_(hmm_.initial_belief()) {}

void BeliefTracker::update(const std::vector<ForecastArrival>& forecasts, ShadowArm* shadow) {
  for (const auto& [stamp, forecast] : forecasts) {
    auto observed = forecast ? observer_.observe(*forecast) : std::nullopt;
    if (observed && shadow) observed->deviation = shadow->observe(*forecast);
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
