// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/belief_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "prf_decision/hmm_file.hpp"
#include "scenario.hpp"

namespace prf_decision {
namespace {

using prf_core::MeasuredMotion;

constexpr double kPeriod = 1 / 30.0;  // s, of the images

ForecastArrival arrival(int image, const Eigen::Vector3d& velocity, const MeasuredMotion& measured,
                        TargetStatus status = TargetStatus::kTracking) {
  auto forecast = std::make_shared<TargetForecast>(
      forecast_of(from_seconds(100 + kPeriod * image), {1, 0, 0.5}, velocity, status));
  forecast->measured_motion = measured;
  return {forecast->stamp, forecast};
}

TEST(BeliefTracker, ObservesTheFasterOfFilterAndMeasurements) {
  MeasuredMotion measured;
  measured.velocity = {0, 0.5, 0};
  measured.velocity_covariance = Eigen::Matrix3d::Identity() * 0.03;
  const auto speed = [](const ObservedMotion& observed) {
    return std::hypot(observed.velocity.norm(), observed.spread);
  };
  const Eigen::Vector3d filtered(0.1, 0, 0);
  EXPECT_NEAR(speed(*observation_of(*arrival(0, filtered, measured).forecast)), 0.4, 1e-12);
  measured.speed = 0.45;
  EXPECT_NEAR(speed(*observation_of(*arrival(0, filtered, measured).forecast)), 0.45, 1e-12);
  const ObservedMotion fast = *observation_of(*arrival(0, {0.6, 0, 0}, measured).forecast);
  EXPECT_EQ(fast.velocity, Eigen::Vector3d(0.6, 0, 0));
  EXPECT_EQ(fast.spread, 0);
  // Measurements beyond the gate still tell that the target moves.
  const auto coasting = arrival(0, filtered, measured, TargetStatus::kCoasting);
  EXPECT_EQ(observation_of(*coasting.forecast)->velocity, measured.velocity);
  EXPECT_FALSE(observation_of(*arrival(0, filtered, {}, TargetStatus::kCoasting).forecast));
}

// Fault 43: measured motion of 1e300 -> bounded observation, the belief stays a distribution
TEST(BeliefTracker, StaysADistributionUnderAbsurdMotion) {
  for (const Eigen::Vector3d& filtered : {Eigen::Vector3d(1e300, 0, 0), Eigen::Vector3d(0, 0, 0)}) {
    BeliefTracker belief(usual_hmm());
    MeasuredMotion measured;
    measured.velocity = {1e300, -1e300, 1e300};
    measured.velocity_covariance = Eigen::Matrix3d::Identity() * 1e300;
    measured.speed = 1e300;
    belief.update({arrival(0, filtered, measured)});
    EXPECT_TRUE(is_distribution(belief.posterior()));
    EXPECT_EQ(belief.intent(), Intent::kReverse);
    EXPECT_EQ(belief.resets(), 0u);
  }
}

// How often the belief is in Forward for a target that shakes with peak speed `peak`, and when it
// leaves Forward first. `truth`: the filter knows the velocity. Else it averages the motion away,
// and only the positions of the images tell of it.
struct Shaken {
  double forward = 0;
  int left_after = 0;  // images
};

Shaken shake(double amplitude, double peak, double phase, bool truth) {
  const double omega = peak / amplitude;
  BeliefTracker belief(load_hmm("config/hmm_default.yaml"));
  for (int image = 0; image < 60; ++image) belief.update({arrival(image, {0, 0, 0}, {})});
  constexpr int kImages = 300;
  std::deque<double> squares;
  Shaken shaken{0, kImages};
  for (int k = 0; k < kImages; ++k) {
    const double time = kPeriod * k;
    const auto position = [&](double t) { return amplitude * std::sin(omega * t + phase); };
    MeasuredMotion measured;
    Eigen::Vector3d filtered(0, 0, 0);
    if (truth) {
      filtered.y() = peak * std::cos(omega * time + phase);
    } else if (k > 0) {
      measured.velocity.y() = (position(time) - position(time - kPeriod)) / kPeriod;
      measured.velocity_covariance = Eigen::Matrix3d::Identity() * 1e-6;
      squares.push_back(measured.velocity.squaredNorm());
      if (squares.size() > 8) squares.pop_front();
      double sum = 0;
      for (const double square : squares) sum += square;
      measured.speed = std::sqrt(sum / static_cast<double>(squares.size()));
    }
    belief.update({arrival(60 + k, filtered, measured)});
    if (belief.intent() == Intent::kForward) {
      shaken.forward += 1.0 / kImages;
    } else {
      shaken.left_after = std::min(shaken.left_after, k);
    }
  }
  return shaken;
}

TEST(BeliefTracker, SeesAShakingTargetThatTheFilterAveragesAway) {
  for (double amplitude = 0.02; amplitude <= 0.101; amplitude += 0.01) {
    for (double peak = 0.3; peak <= 3.01; peak += 0.1) {
      // The observation follows with the second image, where the first velocity between images is.
      // What the belief lags behind one that knows the velocity from the first is at most 0.23 s.
      if (peak / amplitude > 0.99 * M_PI / kPeriod) continue;  // beyond half the image rate
      for (const double phase : {0.0, 0.7, 1.4}) {
        const Shaken truth = shake(amplitude, peak, phase, true);
        const Shaken measured = shake(amplitude, peak, phase, false);
        EXPECT_LE(measured.forward, truth.forward + 0.05) << amplitude << " " << peak;
        EXPECT_LE(measured.left_after, truth.left_after + 7) << amplitude << " " << peak;
      }
    }
  }
}

}  // namespace
}  // namespace prf_decision
