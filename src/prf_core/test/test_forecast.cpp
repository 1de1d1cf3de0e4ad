// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "expect_refused.hpp"
#include "prf_core/bounds.hpp"
#include "random_pose.hpp"

namespace prf_core {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TargetForecast forecast() {
  std::mt19937 random(1);
  TargetForecast result;
  result.stamp = seconds(100);
  result.status = TargetStatus::kTracking;
  for (const int ms : {0, 100, 300}) {
    TargetPrediction prediction;
    prediction.horizon = milliseconds(ms);
    prediction.target = random_moving_pose(random);
    prediction.covariance.diagonal().setConstant(1.0 + ms);
    result.predictions.push_back(prediction);
  }
  return result;
}

TEST(TargetForecast, NeedsNoPredictionsWithoutATarget) {
  for (const TargetStatus status : {TargetStatus::kNoTarget, TargetStatus::kLost}) {
    TargetForecast f = forecast();
    f.status = status;
    EXPECT_NO_THROW(f.validate());
    f.predictions.clear();
    EXPECT_NO_THROW(f.validate());
  }
}

// Fault 1, 2, 42, 43: NaN, no unit quaternion, absurd numbers or stamps in a forecast -> refused
TEST(TargetForecast, IsRefusedByMemberValueAndBound) {
  const std::string no_predictions =
      "predictions = [], must be at least one while the target is tracked or coasted";
  expect_refused<TargetForecast>(
      forecast(),
      {{no_predictions, [](auto& f) { f.predictions.clear(); }},
       {no_predictions, [](auto& f) { f.status = TargetStatus::kCoasting, f.predictions.clear(); }},
       {"since_measurement = -0.001, must be >= 0 s",
        [](auto& f) { f.since_measurement = milliseconds(-1); }},
       {"predictions[0].horizon = 0.001, must be 0 s",
        [](auto& f) { f.predictions[0].horizon = milliseconds(1); }},
       {"predictions[2].horizon = 0.1, must be greater than the one before",
        [](auto& f) { f.predictions[2].horizon = milliseconds(100); }},
       {"predictions[1].pose.position",
        [](auto& f) { f.predictions[1].target.pose.position.x() = NAN; }},
       {"predictions[1].pose.orientation's norm = 0, must be 1 within 0.001",
        [](auto& f) { f.predictions[1].target.pose.orientation.coeffs().setZero(); }},
       {"predictions[1].pose.orientation's norm = 1.002",
        [](auto& f) { f.predictions[1].target.pose.orientation.coeffs() *= 1.002; }},
       {"predictions[2].linear_velocity",
        [](auto& f) { f.predictions[2].target.linear_velocity.x() = INFINITY; }},
       {"predictions[2].angular_velocity",
        [](auto& f) { f.predictions[2].target.angular_velocity.z() = NAN; }},
       {"predictions[2].covariance", [](auto& f) { f.predictions[2].covariance(0, 5) = NAN; }},
       {"stamp", [](auto& f) { f.stamp = kMaxStamp + Duration{1}; }},
       {"predictions[2].horizon = 3601, must be <= 3600 s",
        [](auto& f) { f.predictions[2].horizon = seconds(3601); }},
       {"predictions[0].pose.position",
        [](auto& f) { f.predictions[0].target.pose.position.y() = 1e300; }},
       {"predictions[1].linear_velocity",
        [](auto& f) { f.predictions[1].target.linear_velocity.z() = -1e300; }},
       {"predictions[1].angular_velocity",
        [](auto& f) { f.predictions[1].target.angular_velocity.z() = 1e300; }},
       {"predictions[0].covariance", [](auto& f) { f.predictions[0].covariance(5, 5) = 1e300; }},
       {"measured_velocity", [](auto& f) { f.measured_motion.velocity.x() = 1e300; }},
       {"measured_speed", [](auto& f) { f.measured_motion.speed = 1e300; }}});
}

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

TEST(PredictedTarget, IsThePredictionAtItsHorizon) {
  const TargetForecast f = forecast();
  for (const TargetPrediction& wanted : f.predictions) {
    const TargetPrediction at = predicted_target(f, f.stamp + wanted.horizon);
    EXPECT_EQ(at.horizon, wanted.horizon);
    EXPECT_TRUE(at.target.pose.isometry().isApprox(wanted.target.pose.isometry(), 1e-14));
    EXPECT_TRUE(at.target.linear_velocity.isApprox(wanted.target.linear_velocity, 1e-13));
    EXPECT_TRUE(at.covariance.isApprox(wanted.covariance));
  }
}

TEST(PredictedTarget, InterpolatesBetweenNeighbours) {
  const TargetForecast f = forecast();
  const TargetPrediction at = predicted_target(f, f.stamp + milliseconds(150));
  const MovingPose expected =
      interpolate(f.predictions[1].target, f.predictions[2].target, 0.2, 0.05);
  EXPECT_EQ(at.horizon, milliseconds(150));
  EXPECT_TRUE(at.target.pose.isometry().isApprox(expected.pose.isometry(), 1e-14));
  EXPECT_TRUE(at.target.linear_velocity.isApprox(expected.linear_velocity, 1e-13));
  EXPECT_TRUE(at.target.angular_velocity.isApprox(expected.angular_velocity, 1e-13));
  EXPECT_NEAR(at.covariance(0, 0), 151.0, 1e-12);
}

TEST(PredictedTarget, HoldsTheTargetAtRestOutsideOfTheHorizons) {
  const TargetForecast f = forecast();
  const auto expect_held = [&](Duration horizon, const TargetPrediction& nearest) {
    const TargetPrediction at = predicted_target(f, f.stamp + horizon);
    EXPECT_EQ(at.horizon, horizon);
    EXPECT_EQ(at.target.pose.position, nearest.target.pose.position);
    EXPECT_EQ(at.target.pose.orientation.coeffs(), nearest.target.pose.orientation.coeffs());
    EXPECT_EQ(at.target.linear_velocity, Eigen::Vector3d::Zero());
    EXPECT_EQ(at.target.angular_velocity, Eigen::Vector3d::Zero());
    EXPECT_EQ(at.covariance, nearest.covariance);
  };
  expect_held(Duration{-1}, f.predictions.front());
  expect_held(milliseconds(300) + Duration{1}, f.predictions.back());
  expect_held(seconds(5), f.predictions.back());
}

TEST(PredictedTarget, RefusesAForecastWithoutPredictions) {
  EXPECT_THROW((void)predicted_target(TargetForecast{}, Stamp{0}), std::invalid_argument);
}

}  // namespace
}  // namespace prf_core
