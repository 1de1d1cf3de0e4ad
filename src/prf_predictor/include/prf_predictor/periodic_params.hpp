// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the predictor `periodic`. Meaning, unit and source of each value are in
// config/predictors/periodic.yaml, whose keys are the names of the members.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace prf_predictor {

struct PeriodicParams {
  // Platform.
  double slowest = 0.0;
  double fastest = 0.0;
  double frequency_count = 0.0;
  double platform_amplitude = 0.0;
  double harmonic_amplitude = 0.0;
  double damping_ratio_stepping = 0.0;
  double damping_ratio_calm = 0.0;
  // Fast motion that is soon forgotten, as of a robot that steps.
  double shake_frequency = 0.0;
  double shake_damping_ratio = 0.0;
  double shake_amplitude = 0.0;
  // Slow motion without a frequency.
  double drift_density_stepping = 0.0;
  double drift_density_calm = 0.0;
  double drift_time_constant = 0.0;
  double wander_frequency = 0.0;
  double wander_damping_ratio = 0.0;
  double wander_amplitude_stepping = 0.0;
  double wander_amplitude_calm = 0.0;
  // Hypotheses without periodic motion.
  double moving_density = 0.0;
  double slow_density = 0.0;
  double resting_density = 0.0;
  double long_time_constant = 0.0;
  double short_time_constant = 0.0;
  double autoregressive_window = 0.0;
  double autoregressive_order = 0.0;
  // Weights.
  double memory = 0.0;
  double periodic_prior = 0.0;
  double aperiodic_prior = 0.0;
  double autoregressive_prior = 0.0;
  // Covariance calibration.
  double innovation_memory = 0.0;
  double least_noise_share = 0.0;
  double least_inflation = 0.0;

  // All by their names.
  using Member = std::pair<std::string, double PeriodicParams::*>;
  [[nodiscard]] static const std::vector<Member>& members();

  // Throws std::invalid_argument naming the parameter, its value and its bound.
  void validate() const;
};

}  // namespace prf_predictor
