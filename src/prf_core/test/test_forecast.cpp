// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "expect_refused.hpp"

namespace prf_core {
namespace {

// Circle of 0.1 m at 2 rad/s while turning about z at 0.7 rad/s.
MovingPose circling(double t) {
  MovingPose at;
  at.pose.position = {0.1 * std::cos(2 * t), 0.1 * std::sin(2 * t), 0.5};
  at.pose.orientation = Eigen::AngleAxisd(0.7 * t, Eigen::Vector3d::UnitZ());
  at.linear_velocity = {-0.2 * std::sin(2 * t), 0.2 * std::cos(2 * t), 0};
  at.angular_velocity = {0, 0, 0.7};
  return at;
}

TargetForecast circling_forecast() {
  TargetForecast forecast;
  forecast.stamp = std::chrono::seconds(5);
  forecast.status = TargetStatus::kTracking;
  for (const double horizon : {0.0, 0.1, 0.25, 0.5}) {
    const Eigen::Matrix<double, 6, 6> covariance =
        (1 + horizon) * Eigen::Matrix<double, 6, 6>::Identity();
    forecast.predictions.push_back({from_seconds(horizon), circling(horizon), covariance});
  }
  return forecast;
}

TEST(PredictedTarget, FollowsAMotionBetweenItsHorizons) {
  const TargetForecast forecast = circling_forecast();
  for (double t = 0; t <= 0.5; t += 0.005) {
    const TargetPrediction prediction =
        predicted_target(forecast, forecast.stamp + from_seconds(t));
    const MovingPose& at = prediction.target;
    const MovingPose truth = circling(t);
    // Cubic Hermite error: h^4 / 384 max |x''''| = 0.25^4 / 384 * 1.6 m.
    EXPECT_LT((at.pose.position - truth.pose.position).norm(), 2e-5);
    EXPECT_LT((at.linear_velocity - truth.linear_velocity).norm(), 1e-3);
    EXPECT_LT(at.pose.orientation.angularDistance(truth.pose.orientation), 1e-7);
    EXPECT_LT((at.angular_velocity - truth.angular_velocity).norm(), 1e-9);
    EXPECT_NEAR(prediction.covariance(4, 4), 1 + t, 1e-9);
  }
}

TEST(PredictedTarget, StandsBeyondTheLastHorizon) {
  const TargetForecast forecast = circling_forecast();
  const MovingPose at = predicted_target(forecast, forecast.stamp + from_seconds(3)).target;
  EXPECT_EQ(at.pose.position, forecast.predictions.back().target.pose.position);
  EXPECT_EQ(at.linear_velocity.norm(), 0);
  EXPECT_EQ(at.angular_velocity.norm(), 0);
}

TEST(PredictedTarget, RefusesAForecastWithoutPredictions) {
  EXPECT_THROW((void)predicted_target(TargetForecast(), Stamp{0}), std::invalid_argument);
}

TEST(TargetForecast, RefusesWhatCannotBeActedOn) {
  expect_refused<TargetForecast>(
      circling_forecast(),
      {{"predictions = []", [](auto& f) { f.predictions.clear(); }},
       {"since_measurement", [](auto& f) { f.since_measurement = Duration{-1}; }},
       {"predictions[0].horizon", [](auto& f) { f.predictions[0].horizon = Duration{1}; }},
       {"predictions[2].horizon",
        [](auto& f) { f.predictions[2].horizon = f.predictions[1].horizon; }},
       {"predictions[1].pose.position",
        [](auto& f) { f.predictions[1].target.pose.position.x() = NAN; }},
       {"predictions[1].pose.orientation",
        [](auto& f) { f.predictions[1].target.pose.orientation.coeffs().setZero(); }},
       {"predictions[3].linear_velocity",
        [](auto& f) { f.predictions[3].target.linear_velocity.x() = INFINITY; }},
       {"predictions[2].covariance", [](auto& f) { f.predictions[2].covariance(0, 5) = NAN; }}});
}

}  // namespace
}  // namespace prf_core
