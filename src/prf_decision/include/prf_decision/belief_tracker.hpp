// SPDX-License-Identifier: BSD-3-Clause
// What the decision knows of the target: the newest forecast, when the target was last measured,
// and the HMM's belief, filtered over the velocities of all forecasts.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "prf_decision/hmm.hpp"
#include "prf_decision/tick_gate.hpp"

namespace prf_decision {

class BeliefTracker {
 public:
  // Validates the parameters.
  explicit BeliefTracker(const HmmParams& params);

  // One step of the HMM for each forecast: an observation where the status is kTracking, else a
  // prediction, also for a refused (null) forecast.
  void update(const std::vector<ForecastArrival>& forecasts);

  [[nodiscard]] Intent intent() const { return most_probable(belief_); }
  [[nodiscard]] const Eigen::Vector3d& posterior() const { return belief_.posterior; }
  // The newest that was not refused; null until one has come.
  [[nodiscard]] const std::shared_ptr<const TargetForecast>& forecast() const { return forecast_; }
  // Stamp of the last measurement of the target.
  [[nodiscard]] std::optional<Stamp> measured() const { return measured_; }

 private:
  HmmFilter hmm_;
  HmmBelief belief_;
  std::shared_ptr<const TargetForecast> forecast_;
  std::optional<Stamp> measured_;
};

}  // namespace prf_decision
