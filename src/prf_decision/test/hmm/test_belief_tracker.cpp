// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/belief_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "prf_decision/hmm/hmm_file.hpp"
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

// Fault 43: measured motion of 1e300 -> bounded observation, the belief stays a distribution
TEST(BeliefTracker, StaysADistributionUnderAbsurdMotion) {
  for (const Eigen::Vector3d& filtered : {Eigen::Vector3d(1e300, 0, 0), Eigen::Vector3d(0, 0, 0)}) {
    BeliefTracker belief(usual_hmm());
    MeasuredMotion measured;
    measured.velocity = {1e300, -1e300, 1e300};
    measured.velocity_covariance = Eigen::Matrix3d::Identity() * 1e300;
    belief.update({arrival(0, filtered, measured)});
    EXPECT_TRUE(is_distribution(belief.posterior()));
    EXPECT_EQ(belief.intent(), Intent::kReverse);
    EXPECT_EQ(belief.resets(), 0u);
  }
}

// What a filter makes of the velocity: it knows it, averages it away, follows a third of it,
// follows slowly, or follows two images late.
enum class Filter { kTruth, kAverage, kThird, kSlow, kLate };

// A target that shakes along one axis from the first image on.
struct Shaking {
  double amplitude;  // m
  double omega;      // rad/s
  double phase;

  double position(double time) const { return amplitude * std::sin(omega * time + phase); }
  double velocity(double time) const { return amplitude * omega * std::cos(omega * time + phase); }
};

// How often the belief is in Forward, and the image with which it leaves Forward first.
struct Reaction {
  double forward = 0;
  int left_after = 0;  // images
};

constexpr int kImages = 200;

Reaction react(const Shaking& target, Filter filter) {
  static const HmmParams kHmm = load_hmm("config/hmm_paper.yaml");
  BeliefTracker belief(kHmm);
  for (int image = 0; image < 60; ++image) belief.update({arrival(image, {0, 0, 0}, {})});
  Reaction reaction{0, kImages};
  double slow = 0;
  for (int k = 0; k < kImages; ++k) {
    const double time = kPeriod * k;
    MeasuredMotion measured;
    double between = 0;  // the velocity between this image and the one before
    if (k > 0) between = (target.position(time) - target.position(time - kPeriod)) / kPeriod;
    if (filter != Filter::kTruth && k > 0) {
      measured.velocity.y() = between;
      measured.velocity_covariance = Eigen::Matrix3d::Identity() * 1e-6;
    }
    slow += (1 - std::exp(-kPeriod / 0.3)) * (between - slow);
    const std::array<double, 5> filtered{target.velocity(time), 0, target.velocity(time) / 3, slow,
                                         k < 2 ? 0 : target.velocity(time - 2 * kPeriod)};
    belief.update({arrival(60 + k, {0, filtered[static_cast<std::size_t>(filter)], 0}, measured)});
    if (belief.intent() == Intent::kForward) {
      reaction.forward += 1.0 / kImages;
    } else {
      reaction.left_after = std::min(reaction.left_after, k);
    }
  }
  return reaction;
}

// Amplitudes of 20 to 100 mm, peaks of 0.3 to 3 m/s, below half the image rate.
template <typename Check>
void for_each_shaking(const Check& check) {
  for (int mm = 20; mm <= 100; mm += 10) {
    for (int peak = 3; peak <= 30; ++peak) {  // 0.1 m/s
      const double omega = 100.0 * peak / mm;
      if (omega > 0.99 * M_PI / kPeriod) continue;
      for (const double phase : {0.0, 0.35, 0.7, 1.4}) {
        SCOPED_TRACE(testing::Message() << mm << " mm, " << peak << "e-1 m/s, phase " << phase);
        check(Shaking{1e-3 * mm, omega, phase});
      }
    }
  }
}

TEST(BeliefTracker, IsInForwardNoMoreOftenThanWithTheTrueVelocityWhateverTheFilter) {
  for_each_shaking([](const Shaking& target) {
    const double truth = react(target, Filter::kTruth).forward;
    for (const Filter filter : {Filter::kAverage, Filter::kThird, Filter::kSlow, Filter::kLate}) {
      EXPECT_LE(react(target, filter).forward, truth + 0.05) << static_cast<int>(filter);
    }
  });
}

// The truth is known with the first image, a velocity is measured with the second. A filter that
// follows in part moves the reaction of motions that are hardly too fast, so it is not asked here.
// Near half the image rate, above 12 Hz, the first images can find the target near the same place.
TEST(BeliefTracker, LeavesForwardWithinFourImagesOfOneThatKnowsTheVelocity) {
  for_each_shaking([](const Shaking& target) {
    const int truth = react(target, Filter::kTruth).left_after;
    const int most = target.omega < 2 * M_PI * 12 ? 4 : 6;
    for (const Filter filter : {Filter::kAverage, Filter::kSlow, Filter::kLate}) {
      EXPECT_LE(react(target, filter).left_after, truth + most) << static_cast<int>(filter);
    }
  });
}

// Images show such a motion at another frequency; how far apart they find the target still tells.
TEST(BeliefTracker, SeesAShakingTargetAboveHalfTheImageRate) {
  for (int mm = 20; mm <= 100; mm += 20) {
    for (double hertz = 16; hertz <= 25; hertz += 0.5) {
      for (const double phase : {0.0, 0.7, 1.4, 2.3}) {
        const Reaction reaction = react({1e-3 * mm, 2 * M_PI * hertz, phase}, Filter::kAverage);
        EXPECT_LE(reaction.forward, 0.05) << mm << " mm, " << hertz << " Hz, " << phase;
      }
    }
  }
}

// A stepping robot on a heavy platform: fast, regular, and the filter follows. What is measured is
// noisy (0.4 mm along each axis) and now and then 0.08 m/s off the filter.
TEST(BeliefTracker, StaysInForwardWhereTheFilterFollowsAFastRegularMotion) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.0004);
  BeliefTracker belief(load_hmm("config/hmm_paper.yaml"));
  const double variance = 2 * 1.6e-7 / (kPeriod * kPeriod);
  Eigen::Vector3d before(0, 0, 0);
  for (int k = 0; k < 3000; ++k) {
    const double omega = 9.4;  // 1.5 Hz
    const Eigen::Vector3d velocity(0, 0.3 * std::cos(omega * kPeriod * k), 0);
    const Eigen::Vector3d error(noise(random), noise(random), noise(random));
    MeasuredMotion measured;
    measured.velocity = velocity + (error - before) / kPeriod;
    measured.velocity.y() += k % 20 == 0 ? 0.08 : 0.0;
    measured.velocity_covariance = Eigen::Matrix3d::Identity() * variance;
    before = error;
    belief.update({arrival(k, velocity, measured)});
    ASSERT_EQ(belief.intent(), Intent::kForward) << k;
  }
}

}  // namespace
}  // namespace prf_decision
