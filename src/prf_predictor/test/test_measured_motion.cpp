// SPDX-License-Identifier: BSD-3-Clause
// What is measured of the target's motion follows it within two images.
#include "prf_predictor/measured_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "predictor_files.hpp"
#include "prf_predictor/periodic_predictor.hpp"
#include "resting_target.hpp"

namespace prf_predictor {
namespace {

TEST(MeasuredMotion, IsTheVelocityBetweenTheLatestMeasurementsWithItsCovariance) {
  MeasuredMotionWindow window;
  const Eigen::Matrix3d R = 1e-6 * Eigen::Matrix3d::Identity();
  window.add(Stamp{0}, {0, 0, 0}, R, true);
  EXPECT_FALSE(window.at(Stamp{0}).has_velocity());
  window.add(kFrame, {0.033, 0, -0.066}, R, true);
  const auto motion = window.at(kFrame);
  EXPECT_LT((motion.velocity - Eigen::Vector3d(1, 0, -2)).norm(), 1e-12);
  EXPECT_NEAR(motion.velocity_covariance(1, 1), 2e-6 / (0.033 * 0.033), 1e-12);
  EXPECT_NEAR(motion.speed, std::sqrt(5 - 6e-6 / (0.033 * 0.033)), 1e-9);
  EXPECT_FALSE(window.at(2 * kFrame).has_velocity()) << "that image had no measurement";
  EXPECT_GT(window.at(2 * kFrame).speed, 2);
  EXPECT_EQ(window.at(20 * kFrame).speed, 0);
}

TEST(MeasuredMotion, ForgetsMeasurementsBeforeALongGapAndTakesAPairOfASlowCamera) {
  for (const double gap : {0.25, 2.0}) {
    MeasuredMotionWindow window;
    const Eigen::Matrix3d R = 1e-6 * Eigen::Matrix3d::Identity();
    window.add(Stamp{0}, {0, 0, 0}, R, true);
    window.add(prf_core::from_seconds(gap), {0.5, 0, 0}, R, true);
    EXPECT_EQ(window.at(prf_core::from_seconds(gap)).has_velocity(), gap < 0.6) << gap;
  }
}

// Fault 17: a lone outlier tag half a metre away -> no measured velocity; a second one is believed
TEST(MeasuredMotion, IgnoresALoneOutlierAndBelievesTheSecond) {
  auto tracker = make_tracker();
  rest(tracker, 30);
  const Eigen::Vector3d outlier = kHome + Eigen::Vector3d(0, 0.5, 0);
  const auto speed = [&](int frame, const Eigen::Vector3d& position) {
    const auto state = tracker.process(frame * kFrame, {measurement_at(position)}).state;
    return state.measured_motion.at(state.stamp).speed;
  };
  EXPECT_LT(speed(30, outlier), 0.05);
  EXPECT_LT(speed(31, kHome), 0.05);
  EXPECT_LT(speed(32, kHome), 0.05);
  EXPECT_GT(speed(33, outlier), 5);
}

// The default predictor takes a shaking target for one at rest; the measured speed does not.
TEST(MeasuredMotion, FollowsAShakingTargetWithinTwoImagesOfTheDefaultPredictor) {
  for (const double amplitude : {0.02, 0.05, 0.1}) {
    for (const double peak : {0.3, 1.0, 1.5, 3.0}) {
      const double W = peak / amplitude;
      if (W > 2 * M_PI * 13) continue;  // 13 Hz: below half the image rate
      TargetTracker tracker(good_params(), std::make_shared<PeriodicPredictor>(periodic_params()));
      rest(tracker, 60);
      double least = kInfinity;
      for (int k = 0; k < 40; ++k) {
        const double y = amplitude * std::sin(W * (k + 1) * kFrameSeconds);
        const auto state =
            tracker.process((60 + k) * kFrame, {measurement_at(kHome + Eigen::Vector3d(0, y, 0))})
                .state;
        const auto motion = state.measured_motion.at(state.stamp);
        const double measured = std::max(motion.velocity.norm(), motion.speed);
        const double truth = peak * std::abs(std::cos(W * (k + 1) * kFrameSeconds));
        if (k > 0) {
          EXPECT_GT(measured, 0.25 * truth) << amplitude << " " << peak << " " << k;
        }
        if (k >= 8) least = std::min(least, measured);
      }
      // Within the window the fast ones never rest.
      if (W > 2 * M_PI * 2.3) {
        EXPECT_GT(least, 0.4 * peak) << amplitude << " m, " << peak << " m/s";
      }
    }
  }
}

}  // namespace
}  // namespace prf_predictor
