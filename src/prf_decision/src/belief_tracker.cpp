// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/belief_tracker.hpp"

#include <algorithm>

namespace prf_decision {

BeliefTracker::BeliefTracker(const HmmParams& params)
    : hmm_(params), belief_(hmm_.initial_belief()) {}

void BeliefTracker::update(const std::vector<ForecastArrival>& forecasts) {
  for (const auto& [stamp, forecast] : forecasts) {
    const bool tracked = forecast && forecast->status == TargetStatus::kTracking;
    belief_ = tracked ? hmm_.observe(belief_, forecast->predictions[0].target.linear_velocity)
                      : hmm_.predict(belief_);
    if (!forecast) continue;
    forecast_ = forecast;
    if (forecast->status == TargetStatus::kNoTarget) continue;
    const Stamp measured = stamp - forecast->since_measurement;
    measured_ = std::max(measured_.value_or(measured), measured);
  }
}

}  // namespace prf_decision
