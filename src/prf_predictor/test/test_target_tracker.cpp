// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/target_tracker.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <prf_core/chi_square.hpp>
#include <prf_core/se3.hpp>
#include <random>
#include <string>

#include "prf_predictor/kalman_predictor.hpp"

namespace prf_predictor {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Duration kFrame = std::chrono::milliseconds(33);
constexpr double kFrameSeconds = 0.033;
const std::vector<double> kHorizons{0, 0.1, 0.5, 1.0, 2.0};
const Eigen::Vector3d kHome(0.9, 0.05, 0.3);

TrackerParams good_params() {
  TrackerParams params;
  params.gate_probability = 0.9999;
  params.gate_speed = 0.15;
  params.orientation_gate_sigma = 0.015;
  params.reacquire_hits = 5;
  params.coast_after = 0.15;
  params.lost_after = 1.0;
  return params;
}

TargetTracker make_tracker(VelocityDecay motion = {0.03, 0.6}) {
  return {good_params(),
          std::make_shared<KalmanPredictor>(std::make_shared<DecayingVelocity>(motion),
                                            SigmaPointParams::textbook())};
}

Eigen::Vector3d position_of(const TrackState& state) {
  return state.belief->motion->forecast(0).position;
}

Eigen::Quaterniond orientation_of(const TrackState& state) {
  return state.belief->rotation->forecast(0).orientation;
}

double variance_of(const TrackState& state) {
  return state.belief->motion->forecast(0).covariance(0, 0);
}

TagMeasurement measurement_at(const Eigen::Vector3d& position,
                              const Eigen::Vector3d& rotation = Eigen::Vector3d::Zero()) {
  TagMeasurement measurement;
  measurement.position = position;
  measurement.orientation = prf_core::exp_so3(rotation);
  measurement.position_covariance = 1e-6 * Eigen::Matrix3d::Identity();
  measurement.orientation_covariance = 2.5e-5 * Eigen::Matrix3d::Identity();
  return measurement;
}

// Feeds `frames` images of a resting target, the last of which has the returned result.
TrackerResult rest(TargetTracker& tracker, int frames, Stamp start = Stamp{0}) {
  TrackerResult result;
  for (int i = 0; i < frames; ++i) {
    result = tracker.process(start + i * kFrame, {measurement_at(kHome)});
  }
  return result;
}

bool same(const TrackState& a, const TrackState& b) {
  return a.stamp == b.stamp && a.status == b.status && a.nis == b.nis && a.measured == b.measured &&
         a.belief.has_value() == b.belief.has_value() &&
         (!a.belief || (position_of(a) == position_of(b) && variance_of(a) == variance_of(b) &&
                        orientation_of(a).coeffs() == orientation_of(b).coeffs()));
}

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

TEST(TargetTracker, IsLostAfterALeapOfTheClock) {
  auto tracker = make_tracker();
  rest(tracker, 30);
  const auto state = tracker.process(std::chrono::hours(1), {}).state;
  EXPECT_EQ(state.status, TargetStatus::kLost);
  EXPECT_TRUE(is_finite(state.belief->motion->forecast(0)));
}

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

TEST(TargetTracker, KeepsThePositionOfAFlippedPoseAndDropsItsOrientation) {
  auto tracker = make_tracker();
  rest(tracker, 60);
  const Eigen::Vector3d moved = kHome + Eigen::Vector3d(0.001, 0, 0);
  const auto state = tracker.process(60 * kFrame, {measurement_at(moved, {0, 0.6, 0})}).state;
  EXPECT_TRUE(state.measured);
  EXPECT_TRUE(state.orientation_gated);
  EXPECT_GT(position_of(state).x(), kHome.x());
  EXPECT_LT(prf_core::log_so3(orientation_of(state)).norm(), 1e-3);
}

TEST(TargetTracker, AnswersADuplicateStampAsBeforeAndStaysUnchanged) {
  auto tracker = make_tracker();
  auto reference = make_tracker();
  const auto once = rest(tracker, 20);
  rest(reference, 20);
  const auto twice = tracker.process(19 * kFrame, {measurement_at({5, 5, 5})});
  EXPECT_EQ(twice.arrival, Arrival::kDuplicate);
  EXPECT_TRUE(same(twice.state, once.state));
  EXPECT_TRUE(
      same(tracker.process(20 * kFrame, {}).state, reference.process(20 * kFrame, {}).state));
}

TEST(TargetTracker, ReplaysLateImagesSoThatTheOrderOfArrivalDoesNotMatter) {
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0, 1e-3);
  std::vector<std::vector<TagMeasurement>> images;
  for (int i = 0; i < 30; ++i) {
    const double x = 0.1 * std::sin(2.4 * i * kFrameSeconds) + noise(random);
    images.push_back(i % 7 == 3 ? std::vector<TagMeasurement>{}
                                : std::vector{measurement_at(kHome + Eigen::Vector3d(x, 0, 0))});
  }
  auto in_order = make_tracker();
  auto shuffled = make_tracker();
  TrackState last_in_order;
  TrackState last_shuffled;
  for (std::size_t i = 0; i < images.size(); ++i) {
    last_in_order = in_order.process(i * kFrame, images[i]).state;
  }
  std::vector<std::size_t> order(images.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin() + 1, order.end(), random);
  order.erase(std::find(order.begin(), order.end(), images.size() - 1));
  order.push_back(images.size() - 1);
  for (const std::size_t i : order) {
    last_shuffled = shuffled.process(i * kFrame, images[i]).state;
  }
  EXPECT_TRUE(same(last_in_order, last_shuffled));
}

TEST(TargetTracker, DropsImagesOlderThanItsHistoryAndStartsAnewWhenStampsGoBack) {
  auto tracker = make_tracker();
  const Stamp start = std::chrono::seconds(100);
  const auto last = rest(tracker, 3, start);
  const auto old = tracker.process(start - kFrame, {measurement_at(kHome)});
  EXPECT_EQ(old.arrival, Arrival::kTooOld);
  EXPECT_EQ(old.state.status, TargetStatus::kNoTarget);
  EXPECT_TRUE(same(tracker.process(last.state.stamp, {}).state, last.state));
  const auto anew = tracker.process(start - std::chrono::seconds(5), {});
  EXPECT_EQ(anew.arrival, Arrival::kBackwardJump);
  EXPECT_EQ(anew.state.status, TargetStatus::kNoTarget);
}

TEST(TargetTracker, StaysFiniteWithHalfOfTheImagesMissing) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> noise(0, 1e-3);
  auto tracker = make_tracker();
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d truth =
        kHome + Eigen::Vector3d(0.02, 0.1, 0.05) * std::sin(2.4 * i * kFrameSeconds);
    std::vector<TagMeasurement> measurements;
    if (uniform(random) > 0.5) {
      measurements.push_back(
          measurement_at(truth + Eigen::Vector3d(noise(random), noise(random), 0)));
    }
    const auto state = tracker.process(i * kFrame, measurements).state;
    if (!state.belief) continue;
    ASSERT_TRUE(is_finite(state.belief->motion->forecast(0)));
    if (i > 60) worst = std::max(worst, (position_of(state) - truth).norm());
  }
  EXPECT_LT(worst, 0.05);
}

TEST(TrackerParams, NameTheValueThatIsOutOfBounds) {
  struct BadValue {
    std::string name;
    void (*spoil)(TrackerParams&);
  };
  const BadValue catalogue[] = {
      {"orientation_gate_sigma", [](TrackerParams& p) { p.orientation_gate_sigma = NAN; }},
      {"gate_probability", [](TrackerParams& p) { p.gate_probability = 1; }},
      {"gate_speed", [](TrackerParams& p) { p.gate_speed = -1; }},
      {"reacquire_hits", [](TrackerParams& p) { p.reacquire_hits = 1; }},
      {"coast_after", [](TrackerParams& p) { p.coast_after = NAN; }},
      {"lost_after", [](TrackerParams& p) { p.lost_after = 0.1; }},
  };
  for (const auto& bad : catalogue) {
    auto params = good_params();
    bad.spoil(params);
    try {
      params.validate();
      ADD_FAILURE() << bad.name << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind(bad.name + " = ", 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace prf_predictor
