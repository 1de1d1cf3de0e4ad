// SPDX-License-Identifier: BSD-3-Clause
// A tracker with usual parameters, and measurements of a target for it.
#pragma once

#include <chrono>
#include <limits>
#include <memory>
#include <prf_core/se3.hpp>
#include <vector>

#include "prf_predictor/kalman_predictor.hpp"
#include "prf_predictor/target_tracker.hpp"

namespace prf_predictor {
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr Duration kFrame = std::chrono::milliseconds(33);
inline constexpr double kFrameSeconds = 0.033;
inline const std::vector<double> kHorizons{0, 0.1, 0.5, 1.0, 2.0};
inline const Eigen::Vector3d kHome(0.9, 0.05, 0.3);

inline TrackerParams good_params() {
  TrackerParams params;
  params.gate_probability = 0.9999;
  params.gate_speed = 0.15;
  params.orientation_gate_sigma = 0.015;
  params.orientation_gate_speed = 0.1;
  params.reacquire_hits = 5;
  params.coast_after = 0.15;
  params.lost_after = 1.0;
  return params;
}

inline TargetTracker make_tracker(VelocityDecay motion = {0.03, 0.6}) {
  return {good_params(),
          std::make_shared<KalmanPredictor>(std::make_shared<DecayingVelocity>(motion),
                                            SigmaPointParams::textbook())};
}

inline Eigen::Vector3d position_of(const TrackState& state) {
  return state.belief->motion->forecast(0).position;
}

inline Eigen::Quaterniond orientation_of(const TrackState& state) {
  return state.belief->rotation->forecast(0).orientation;
}

inline double variance_of(const TrackState& state) {
  return state.belief->motion->forecast(0).covariance(0, 0);
}

inline TagMeasurement measurement_at(const Eigen::Vector3d& position,
                                     const Eigen::Vector3d& rotation = Eigen::Vector3d::Zero()) {
  TagMeasurement measurement;
  measurement.position = position;
  measurement.orientation = prf_core::exp_so3(rotation);
  measurement.position_covariance = 1e-6 * Eigen::Matrix3d::Identity();
  measurement.orientation_covariance = 2.5e-5 * Eigen::Matrix3d::Identity();
  return measurement;
}

// Feeds `frames` images of a resting target, the last of which has the returned result.
inline TrackerResult rest(TargetTracker& tracker, int frames, Stamp start = Stamp{0}) {
  TrackerResult result;
  for (int i = 0; i < frames; ++i) {
    result = tracker.process(start + i * kFrame, {measurement_at(kHome)});
  }
  return result;
}

inline bool same(const TrackState& a, const TrackState& b) {
  return a.stamp == b.stamp && a.status == b.status && a.nis == b.nis && a.measured == b.measured &&
         a.belief.has_value() == b.belief.has_value() &&
         (!a.belief || (position_of(a) == position_of(b) && variance_of(a) == variance_of(b) &&
                        orientation_of(a).coeffs() == orientation_of(b).coeffs()));
}

}  // namespace prf_predictor
