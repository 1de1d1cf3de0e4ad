// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/motion_observer.hpp"

#include <algorithm>
#include <cmath>

namespace prf_decision {
namespace {

// A square may have overflown, and a difference of such squares is no number.
double bounded(double square) {
  constexpr double kMost = kMaxObservedSpeed * kMaxObservedSpeed;
  return std::isnan(square) ? kMost : std::clamp(square, 0.0, kMost);
}

}  // namespace

std::optional<ObservedMotion> MotionObserver::observe(const TargetForecast& forecast) {
  const prf_core::MeasuredMotion& measured = forecast.measured_motion;
  const bool tracked = forecast.status == TargetStatus::kTracking && !forecast.predictions.empty();
  while (!hidden_.empty() && forecast.stamp - hidden_.front().stamp >= kHeld) hidden_.pop_front();
  if (!tracked && !measured.has_velocity()) return std::nullopt;

  ObservedMotion observation;
  observation.velocity =
      tracked ? forecast.predictions[0].target.linear_velocity : measured.velocity;
  double square = 0;
  if (measured.has_velocity()) {
    const double noise = measured.velocity_covariance.trace();
    const Eigen::Vector3d residual = measured.velocity - observation.velocity;
    const double hidden = bounded(kChord * kChord * (residual.squaredNorm() - kNoise * noise));
    if (hidden > 0) hidden_.push_back({forecast.stamp, hidden});
    square = bounded(measured.velocity.squaredNorm() - noise - observation.velocity.squaredNorm());
  }
  double largest = 0;
  double second = 0;
  for (const Hidden& hidden : hidden_) {
    second = std::max(second, std::min(largest, hidden.square));
    largest = std::max(largest, hidden.square);
  }
  square = std::max(square, second);
  observation.spread = std::sqrt(square);
  return observation;
}

}  // namespace prf_decision
