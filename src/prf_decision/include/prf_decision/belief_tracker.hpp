// SPDX-License-Identifier: BSD-3-Clause
// What the decision knows of the target: the newest forecast, when the target was last measured,
// and the HMM's belief, filtered over the motions of all forecasts (motion_observer.hpp).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "prf_decision/hmm.hpp"
#include "prf_decision/motion_observer.hpp"
#include "prf_decision/shadow_arm.hpp"
#include "prf_decision/tick_gate.hpp"

namespace prf_decision {

class BeliefTracker {
 public:
  // Validates the parameters.
  explicit BeliefTracker(const HmmParams& params);

  // One step of the HMM for each forecast: an observation where there is one, else a prediction,
  // also for a refused (null) forecast. With a shadow arm its deviations are observed, too.
  void update(const std::vector<ForecastArrival>& forecasts, ShadowArm* shadow = nullptr);

  [[nodiscard]] Intent intent() const { return most_probable(belief_); }
  [[nodiscard]] const Eigen::Vector3d& posterior() const { return belief_.posterior; }
  // The latest observation's speed and spread as one, m/s; 0 before the first one.
  [[nodiscard]] double speed() const { return speed_; }
  // Whether the posterior was no distribution, reset, and not observed since; how often that was.
  [[nodiscard]] bool was_reset() const { return belief_.was_reset; }
  [[nodiscard]] std::size_t resets() const { return resets_; }
  // The newest that was not refused; null until one has come.
  [[nodiscard]] const std::shared_ptr<const TargetForecast>& forecast() const { return forecast_; }
  // Stamp of the last measurement of the target.
  [[nodiscard]] std::optional<Stamp> measured() const { return measured_; }

 private:
  HmmFilter hmm_;
  MotionObserver observer_;
  HmmBelief belief_;
  double speed_ = 0;
  std::size_t resets_ = 0;
  std::shared_ptr<const TargetForecast> forecast_;
  std::optional<Stamp> measured_;
};

}  // namespace prf_decision
