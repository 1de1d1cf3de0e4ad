// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "prf_core/bounds.hpp"
#include "prf_core/require.hpp"

namespace prf_core {
namespace {

void validate_prediction(const std::string& name, const TargetPrediction& prediction) {
  require_pose(name + ".pose", prediction.target.pose);
  const auto& [pose, linear, angular] = prediction.target;
  require_within(name + ".linear_velocity", linear, kMaxSpeed, "m/s");
  require_within(name + ".angular_velocity", angular, kMaxAngularSpeed, "rad/s");
  require_within(name + ".covariance", prediction.covariance, kMaxVariance, "m^2");
}

}  // namespace

void TargetForecast::validate() const {
  require_stamp("stamp", stamp);
  require(since_measurement >= Duration{0}, "since_measurement", to_seconds(since_measurement),
          ">= 0 s");
  require_within("measured_velocity", measured_motion.velocity, kMaxSpeed, "m/s");
  require_within("measured_velocity_covariance", measured_motion.velocity_covariance, kMaxVariance,
                 "(m/s)^2");
  require_between("measured_speed", measured_motion.speed, 0.0, kMaxSpeed, "m/s");
  const bool has_target = status == TargetStatus::kTracking || status == TargetStatus::kCoasting;
  require(!has_target || !predictions.empty(), "predictions", "[]",
          "at least one while the target is tracked or coasted");
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    const std::string name = "predictions[" + std::to_string(i) + "]";
    const Duration horizon = predictions[i].horizon;
    const bool rises = i == 0 ? horizon == Duration{0} : horizon > predictions[i - 1].horizon;
    require(rises, name + ".horizon", to_seconds(horizon),
            i == 0 ? "0 s" : "greater than the one before");
    require(horizon <= kMaxHorizon, name + ".horizon", to_seconds(horizon), "<= 3600 s");
    validate_prediction(name, predictions[i]);
  }
}

TargetPrediction predicted_target(const TargetForecast& forecast, Stamp stamp) {
  const auto& predictions = forecast.predictions;
  require(!predictions.empty(), "predictions", "[]", "at least one");
  const Duration horizon = stamp - forecast.stamp;
  const auto next =
      std::upper_bound(predictions.begin(), predictions.end(), horizon,
                       [](Duration value, const auto& entry) { return value < entry.horizon; });
  if (next == predictions.begin() || next == predictions.end()) {
    TargetPrediction nearest = next == predictions.end() ? predictions.back() : predictions[0];
    if (nearest.horizon != horizon) nearest.target = {nearest.target.pose, {0, 0, 0}, {0, 0, 0}};
    nearest.horizon = horizon;
    return nearest;
  }
  const TargetPrediction& start = *std::prev(next);
  const double span = to_seconds(next->horizon - start.horizon);
  const double time = to_seconds(horizon - start.horizon);
  const double s = time / span;
  return {horizon, interpolate(start.target, next->target, span, time),
          (1.0 - s) * start.covariance + s * next->covariance};
}

}  // namespace prf_core
