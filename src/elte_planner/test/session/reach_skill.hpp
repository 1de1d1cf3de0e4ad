// SPDX-License-Identifier: BSD-3-Clause
// A reach to a target, and forecasts of that target.
#pragma once

#include <cmath>

#include "elte_planner/skill_session.hpp"

namespace elte_planner {

using prf_core::from_seconds;
using prf_core::TargetForecast;
using prf_core::TargetPrediction;
using prf_core::TargetStatus;

inline constexpr prf_core::Stamp kStamp = std::chrono::seconds(10);  // of every forecast

inline Demonstration reach() {
  std::vector<TimedPose> samples;
  for (int i = 0; i <= 200; ++i) {
    const double s = i / 200.0;
    samples.push_back({0.04 * i,
                       {{0.3 + 0.3 * s, 0.1 * std::sin(M_PI * s), 0.2 + 0.2 * s * s},
                        Eigen::Quaterniond(Eigen::AngleAxisd(0.6 * s, Eigen::Vector3d::UnitY()))}});
  }
  const Pose target{{1.0, 0.0, 0.5},
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()))};
  return Demonstration(samples, "arm", "hand", target);
}

inline SessionParams params() {
  SessionParams result;
  result.planner = "elte";
  result.nodes = 50;
  result.horizon_max = 2.0;
  result.confidence = 0.5;
  result.radius_min = 0.001;
  result.radius_max = 0.02;
  return result;
}

inline TargetPrediction prediction(double horizon, const Eigen::Vector3d& offset,
                                   double deviation) {
  Pose target = reach().target();
  target.position += offset;
  TargetPrediction result;
  result.horizon = from_seconds(horizon);
  result.target.pose = target;
  result.covariance.topLeftCorner<3, 3>().diagonal().setConstant(deviation * deviation);
  return result;
}

// Drifts by 0.1 m/s along y, deviation growing from 1 mm by 10 mm/s.
inline TargetForecast drifting(TargetStatus status = TargetStatus::kTracking) {
  TargetForecast forecast;
  forecast.stamp = kStamp;
  forecast.status = status;
  for (const double horizon : {0.0, 0.5, 1.0, 2.0, 4.0}) {
    forecast.predictions.push_back(
        prediction(horizon, {0.0, 0.1 * horizon, 0.02}, 0.001 + 0.01 * horizon));
    forecast.predictions.back().target.linear_velocity.y() = 0.1;
  }
  return forecast;
}

// At its demonstrated place for good.
inline TargetForecast resting() {
  TargetForecast forecast;
  forecast.stamp = kStamp;
  forecast.status = TargetStatus::kTracking;
  forecast.predictions = {prediction(0.0, {0.0, 0.0, 0.0}, 0.1)};
  return forecast;
}

inline Progress at(Eigen::Index frozen, double time_to_go) {
  return {kStamp + std::chrono::milliseconds(100), kStamp, frozen, from_seconds(time_to_go)};
}

inline double end_distance(const SkillResult& result, const Pose& goal) {
  return (result.poses.back().pose.position - goal.position).lpNorm<1>();
}

}  // namespace elte_planner
