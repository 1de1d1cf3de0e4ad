// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/motion_observer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scenario.hpp"

namespace prf_decision {
namespace {

// A forecast `image` periods of 33 ms after the first one.
TargetForecast forecast_at(int image, const Eigen::Vector3d& filtered,
                           const Eigen::Vector3d& measured, double variance = 1e-8,
                           TargetStatus status = TargetStatus::kTracking) {
  TargetForecast forecast =
      forecast_of(std::chrono::seconds(100) + image * std::chrono::milliseconds(33), {1, 0, 0.5},
                  filtered, status);
  forecast.measured_motion.velocity = measured;
  forecast.measured_motion.velocity_covariance = Eigen::Matrix3d::Identity() * variance;
  return forecast;
}

double speed(const std::optional<ObservedMotion>& observed) {
  return std::hypot(observed->velocity.norm(), observed->spread);
}

TEST(MotionObserver, ObservesTheFilterWhereTheMeasurementsAgreeWithIt) {
  MotionObserver observer;
  const auto observed = observer.observe(forecast_at(0, {0.6, 0, 0}, {0.6, 0, 0}));
  EXPECT_EQ(observed->velocity, Eigen::Vector3d(0.6, 0, 0));
  EXPECT_EQ(observed->spread, 0);
}

TEST(MotionObserver, IsAtLeastAsFastAsTheMeasurementOfItsImage) {
  MotionObserver observer;
  EXPECT_NEAR(speed(observer.observe(forecast_at(0, {0.4, 0, 0}, {0.5, 0, 0}))), 0.5, 1e-6);
  MotionObserver noisy;  // 0.25 - 3 * 0.03
  EXPECT_NEAR(speed(noisy.observe(forecast_at(0, {0.2, 0, 0}, {0.5, 0, 0}, 0.03))), 0.4, 1e-12);
}

TEST(MotionObserver, HoldsWhatTheFilterDoesNotShowForAQuarterOfASecond) {
  MotionObserver observer;
  const double c = MotionObserver::kChord;
  const auto spread = [&](int image, const Eigen::Vector3d& v, const Eigen::Vector3d& z) {
    return observer.observe(forecast_at(image, v, z))->spread;
  };
  EXPECT_NEAR(spread(0, {0, 0, 0}, {0, 0.5, 0}), 0.5, 1e-5);
  EXPECT_NEAR(spread(1, {0, 0, 0}, {0, 0, 0}), 0, 1e-5) << "one image alone is not held";
  EXPECT_NEAR(spread(2, {0, 0, 0}, {0, 0.4, 0}), 0.4 * c, 1e-5);
  EXPECT_NEAR(spread(7, {0, 0, 0}, {0, 0, 0}), 0.4 * c, 1e-5);
  EXPECT_EQ(spread(8, {0, 0, 0}, {0, 0, 0}), 0);
}

TEST(MotionObserver, TakesNoiseForNoMotion) {
  MotionObserver observer;  // 0.21^2 < 5 * 3 * 0.003, but more than 3 * 0.003
  EXPECT_TRUE(observer.observe(forecast_at(0, {0, 0, 0}, {0, 0.21, 0}, 0.003)));
  EXPECT_EQ(observer.observe(forecast_at(1, {0, 0, 0}, {0, 0, 0}, 0.003))->spread, 0);
}

// Measurements beyond the gate still tell that the target moves.
TEST(MotionObserver, ObservesMeasurementsThatTheFilterRefused) {
  MotionObserver observer;
  const auto refused = forecast_at(0, {0.1, 0, 0}, {0, 0.5, 0}, 1e-8, TargetStatus::kCoasting);
  EXPECT_EQ(observer.observe(refused)->velocity, Eigen::Vector3d(0, 0.5, 0));
  const auto hidden = forecast_at(1, {0.1, 0, 0}, {0, 0, 0}, 0, TargetStatus::kCoasting);
  EXPECT_FALSE(observer.observe(hidden));
}

}  // namespace
}  // namespace prf_decision
