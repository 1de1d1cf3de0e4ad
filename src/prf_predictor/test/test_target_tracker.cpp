// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <prf_core/chi_square.hpp>
#include <random>
#include <string>

#include "resting_target.hpp"

namespace prf_predictor {
namespace {

// Fault 6: nothing seen yet -> no target, no predictions
TEST(TargetTracker, KnowsNoTargetUntilOneIsSeen) {
  auto tracker = make_tracker();
  const auto blind = tracker.process(Stamp{0}, {});
  EXPECT_EQ(blind.state.status, TargetStatus::kNoTarget);
  EXPECT_TRUE(tracker.forecast(blind.state, kHorizons).empty());
  const auto first = tracker.process(kFrame, {measurement_at(kHome)});
  EXPECT_EQ(first.state.status, TargetStatus::kTracking);
  EXPECT_TRUE(first.state.measured);
  EXPECT_EQ(tracker.forecast(first.state, kHorizons).size(), kHorizons.size());
}

TEST(TargetTracker, ForecastsAConstantVelocityTargetExactly) {
  auto tracker = make_tracker({0.03, kInfinity});
  const Eigen::Vector3d velocity(0.1, -0.2, 0.05);
  const auto position = [&](double t) -> Eigen::Vector3d { return kHome + velocity * t; };
  TrackerResult result;
  for (int i = 0; i < 400; ++i) {
    result = tracker.process(i * kFrame, {measurement_at(position(i * kFrameSeconds))});
  }
  for (const auto& prediction : tracker.forecast(result.state, kHorizons)) {
    const Eigen::Vector3d truth =
        position(399 * kFrameSeconds + prf_core::to_seconds(prediction.horizon));
    EXPECT_LT((prediction.target.pose.position - truth).norm(), 1e-9) << prediction.horizon.count();
    EXPECT_LT((prediction.target.linear_velocity - velocity).norm(), 1e-9);
  }
}

TEST(TargetTracker, ForecastCovarianceIsPositiveDefiniteAndGrowsWithTheHorizon) {
  auto tracker = make_tracker();
  const auto result = rest(tracker, 30);
  double last = 0;
  for (const auto& prediction : tracker.forecast(result.state, kHorizons)) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(prediction.covariance);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 0);
    EXPECT_GT(prediction.covariance(0, 0), last);
    last = prediction.covariance(0, 0);
  }
}

// Fault 14: no images with the tag -> coasts with growing covariance, then lost
TEST(TargetTracker, CoastsWithGrowingCovarianceThenIsLostAndStandsStill) {
  auto tracker = make_tracker();
  double variance = variance_of(rest(tracker, 30).state);
  const int last_measured = 29;
  for (int i = 30; i < 80; ++i) {
    const auto state = tracker.process(i * kFrame, {}).state;
    const double gap = (i - last_measured) * kFrameSeconds;
    const auto expected = gap > 1.0    ? TargetStatus::kLost
                          : gap > 0.15 ? TargetStatus::kCoasting
                                       : TargetStatus::kTracking;
    ASSERT_EQ(state.status, expected) << gap;
    ASSERT_FALSE(state.measured);
    if (expected == TargetStatus::kLost) {
      ASSERT_EQ(variance_of(state), variance);
    } else {
      ASSERT_GT(variance_of(state), variance);
    }
    variance = variance_of(state);
  }
}

// Fault 13: the clock leaps forward by an hour -> lost, still finite
TEST(TargetTracker, IsLostAfterALeapOfTheClock) {
  auto tracker = make_tracker();
  rest(tracker, 30);
  const auto state = tracker.process(std::chrono::hours(1), {}).state;
  EXPECT_EQ(state.status, TargetStatus::kLost);
  EXPECT_TRUE(is_finite(state.belief->motion->forecast(0)));
}

// Fault 17: an outlier of the right id 0.5 m away -> gated, the target stays
TEST(TargetTracker, GatesAnOutlierAndKeepsTheTarget) {
  auto tracker = make_tracker();
  rest(tracker, 30);
  const Eigen::Vector3d outlier = kHome + Eigen::Vector3d(0, 0.5, 0);
  const auto alone = tracker.process(30 * kFrame, {measurement_at(outlier)}).state;
  EXPECT_TRUE(alone.gated);
  EXPECT_FALSE(alone.measured);
  EXPECT_LT((position_of(alone) - kHome).norm(), 1e-3);
  for (int i = 31; i < 60; ++i) {
    const auto state =
        tracker.process(i * kFrame, {measurement_at(outlier), measurement_at(kHome)}).state;
    ASSERT_TRUE(state.measured);
    ASSERT_LT((position_of(state) - kHome).norm(), 1e-3);
  }
}

TEST(TargetTracker, FollowsAJerkOfSomeMillimetresButNotOfCentimetres) {
  for (const double jerk : {0.008, 0.015, 0.05, 0.2}) {
    auto tracker = make_tracker({1e-4, 0.6});
    rest(tracker, 60);
    const auto state =
        tracker.process(60 * kFrame, {measurement_at(kHome + Eigen::Vector3d(0, jerk, 0))}).state;
    EXPECT_EQ(state.measured, jerk < 0.02) << jerk;
    EXPECT_GT(state.nis, prf_core::chi_square_quantile(3, 0.9999)) << "NIS is not widened";
  }
}

// The target may leave the image just when a foot slips: the track must survive that.
TEST(TargetTracker, OpensTheGateTheLongerTheTargetWasNotSeen) {
  for (const int missed : {0, 3, 9}) {
    auto tracker = make_tracker({1e-4, 0.6});
    rest(tracker, 60);
    for (int i = 0; i < missed; ++i) tracker.process((60 + i) * kFrame, {});
    const auto jerked = measurement_at(kHome + Eigen::Vector3d(0, 0.07, 0));
    EXPECT_EQ(tracker.process((60 + missed) * kFrame, {jerked}).state.measured, missed > 0)
        << missed;
    const auto outlier = measurement_at(kHome + Eigen::Vector3d(0, 0.5, 0));
    EXPECT_FALSE(tracker.process((61 + missed) * kFrame, {outlier}).state.measured) << missed;
  }
}

// Fault 17: consistent hits elsewhere -> re-acquired; scattered ones never
TEST(TargetTracker, ReacquiresAfterConsistentHitsOnly) {
  auto tracker = make_tracker();
  rest(tracker, 30);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 30; i < 38; ++i) {
    const Eigen::Vector3d anywhere =
        kHome + Eigen::Vector3d(uniform(random), 1 + uniform(random), uniform(random));
    const auto state = tracker.process(i * kFrame, {measurement_at(anywhere)}).state;
    ASSERT_FALSE(state.reacquired) << "scattered outliers must not become the target";
  }
  const Eigen::Vector3d moved = kHome + Eigen::Vector3d(0, 0.5, 0);
  for (int hit = 1; hit <= 5; ++hit) {
    const auto state = tracker.process((37 + hit) * kFrame, {measurement_at(moved)}).state;
    ASSERT_EQ(state.reacquired, hit == 5);
    ASSERT_EQ(state.measured, hit == 5);
  }
  const auto after = tracker.process(43 * kFrame, {});
  ASSERT_TRUE(after.state.belief);
  EXPECT_LT((position_of(after.state) - moved).norm(), 1e-3);
}

TEST(TargetTracker, BringsALostTargetBackAfterConsistentHits) {
  auto tracker = make_tracker();
  rest(tracker, 30);
  const Stamp later = 30 * kFrame + std::chrono::seconds(5);
  for (int hit = 1; hit <= 5; ++hit) {
    const auto state = tracker.process(later + hit * kFrame, {measurement_at(kHome)}).state;
    ASSERT_EQ(state.status, hit == 5 ? TargetStatus::kTracking : TargetStatus::kLost);
  }
}

// Fault 18: a flipped pose -> its position is used, its orientation is not
TEST(TargetTracker, KeepsThePositionOfAFlippedPoseAndDropsItsOrientation) {
  auto tracker = make_tracker();
  rest(tracker, 60);
  const Eigen::Vector3d moved = kHome + Eigen::Vector3d(0.001, 0, 0);
  const auto state = tracker.process(60 * kFrame, {measurement_at(moved, {0, 0.6, 0})}).state;
  EXPECT_TRUE(state.measured);
  EXPECT_TRUE(state.orientation.gated);
  EXPECT_GT(position_of(state).x(), kHome.x());
  EXPECT_LT(prf_core::log_so3(orientation_of(state)).norm(), 1e-3);
}

// Fault 17: outliers that come beside a target that jumped -> it is re-acquired all the same
TEST(TargetTracker, ReacquiresBesideScatteredOutliers) {
  auto tracker = make_tracker();
  rest(tracker, 30);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Eigen::Vector3d moved = kHome + Eigen::Vector3d(0, 0.5, 0);
  TrackState state;
  for (int k = 30; k < 36; ++k) {
    const Eigen::Vector3d outlier =
        kHome + Eigen::Vector3d(uniform(random), 1.7 + uniform(random), uniform(random));
    state = tracker.process(k * kFrame, {measurement_at(outlier), measurement_at(moved)}).state;
  }
  EXPECT_EQ(state.status, TargetStatus::kTracking);
  EXPECT_LT((position_of(state) - moved).norm(), 1e-2);
}

// Fault 12: the clock stands, the same image again and again -> nothing changes, no time passes
TEST(TargetTracker, LetsNoTimePassWithoutImages) {
  auto tracker = make_tracker();
  const auto before = rest(tracker, 30).state;
  for (int k = 0; k < 100; ++k) {
    EXPECT_TRUE(same(before, tracker.process(before.stamp, {}).state));
  }
}

// Fault 20, 21: a belief that is no longer finite -> dropped, the filter starts anew
TEST(TargetTracker, StartsAnewWhenItsBeliefIsNotFinite) {
  class Diverging : public TargetPredictor {
   public:
    [[nodiscard]] std::unique_ptr<TargetPredictor> clone() const override {
      return std::make_unique<Diverging>(*this);
    }
    void begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) override {
      forecast_.position = position;
      forecast_.covariance.setIdentity();
      forecast_.covariance.topLeftCorner<3, 3>() = covariance;
      steps_ = 0;
    }
    void advance(double /*dt*/) override {
      if (++steps_ == 10) forecast_.covariance(0, 0) = std::nan("");
    }
    void correct(const Eigen::Vector3d& /*p*/, const Eigen::Matrix3d& /*R*/) override {}
    [[nodiscard]] PointForecast forecast(double /*horizon*/) const override { return forecast_; }

   private:
    PointForecast forecast_;
    int steps_ = 0;
  };
  TargetTracker tracker(good_params(), std::make_shared<Diverging>());
  for (int k = 0; k < 30; ++k) {
    const auto state = tracker.process(k * kFrame, {measurement_at(kHome)}).state;
    ASSERT_EQ(state.reinitialised, k == 10 || k == 20) << k;
    ASSERT_TRUE(is_finite(state.belief->motion->forecast(0))) << k;
    ASSERT_EQ(state.status, TargetStatus::kTracking);
  }
}

}  // namespace
}  // namespace prf_predictor
