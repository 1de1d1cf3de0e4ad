// SPDX-License-Identifier: BSD-3-Clause
// Images that come twice, late or not at all, and parameters out of bounds.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "predictor_files.hpp"
#include "resting_target.hpp"

namespace prf_predictor {
namespace {

// Images with jitter, gaps, outliers and a target that is lost and comes back, from `begin` s to
// `end` s. Returns the heap in use at most during the last third, MB.
double memory_of(TargetTracker& tracker, int begin, int end) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 1e-3);
  constexpr int kRate = 30;
  double most = 0.0;
  for (int i = begin * kRate; i < end * kRate; ++i) {
    const double t = static_cast<double>(i) / kRate;
    const Eigen::Vector3d position =
        kHome + Eigen::Vector3d(0.05 * std::sin(2.4 * t) + noise(random), noise(random), 0);
    std::vector<TagMeasurement> measurements;
    if (i % 900 > 60) measurements.push_back(measurement_at(position));
    if (i % 50 < 8) measurements.push_back(measurement_at(position + Eigen::Vector3d(0, 0.5, 0)));
    (void)tracker.forecast(tracker.process(prf_core::from_seconds(t), measurements).state,
                           kHorizons);
    const auto heap = mallinfo2();
    if (i > kRate * (begin + 2 * end) / 3) {
      most = std::max(most, 1e-6 * static_cast<double>(heap.uordblks + heap.hblkhd));
    }
  }
  return most;
}

// All that is kept is filled after ten seconds.
TEST(TargetTracker, KeepsNoMoreAfterSixMinutesThanAfterOne) {
  TargetTracker tracker(good_params(), make_predictor("periodic", values_of("periodic")));
  const double after_one = memory_of(tracker, 0, 60);
  EXPECT_LT(memory_of(tracker, 60, 360), 1.15 * after_one);
}

// Fault 9, 40: an image twice -> the same forecast again, nothing changes
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

// Fault 7: a late image within the last second -> inserted, later ones computed again
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

// Fault 8, 11, 40: older than all history -> dropped; three in a row that went back -> a new
// run
TEST(TargetTracker, DropsImagesOlderThanItsHistoryAndStartsAnewWhenStampsGoBack) {
  auto tracker = make_tracker();
  const Stamp start = std::chrono::seconds(100);
  const auto last = rest(tracker, 3, start);
  const auto old = tracker.process(start - kFrame, {measurement_at(kHome)});
  EXPECT_EQ(old.arrival, Arrival::kTooOld);
  EXPECT_EQ(old.state.status, TargetStatus::kNoTarget);
  EXPECT_TRUE(same(tracker.process(last.state.stamp, {}).state, last.state));
  const Stamp earlier = start - std::chrono::seconds(5);
  for (const int i : {0, 1}) {
    EXPECT_EQ(tracker.process(earlier + i * kFrame, {}).arrival, Arrival::kTooOld);
  }
  const auto anew = tracker.process(earlier + 2 * kFrame, {});
  EXPECT_EQ(anew.arrival, Arrival::kBackwardJump);
  EXPECT_EQ(anew.state.status, TargetStatus::kNoTarget);
}

// Fault 14: half of the images missing -> coasts, stays finite and near the target
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

// Fault 28, 52: gates of 1e308, times of 5e-324, NaN -> refused by their names
TEST(TrackerParams, NameTheValueThatIsOutOfBounds) {
  struct BadValue {
    std::string name;
    void (*spoil)(TrackerParams&);
  };
  const BadValue catalogue[] = {
      {"orientation_gate_sigma", [](TrackerParams& p) { p.orientation_gate_sigma = NAN; }},
      {"gate_probability", [](TrackerParams& p) { p.gate_probability = 1; }},
      {"gate_speed", [](TrackerParams& p) { p.gate_speed = -1; }},
      {"gate_speed", [](TrackerParams& p) { p.gate_speed = 1e308; }},
      {"orientation_gate_speed", [](TrackerParams& p) { p.orientation_gate_speed = 1e308; }},
      {"orientation_gate_sigma", [](TrackerParams& p) { p.orientation_gate_sigma = 1e308; }},
      {"reacquire_hits", [](TrackerParams& p) { p.reacquire_hits = 2000000000; }},
      {"coast_after", [](TrackerParams& p) { p.coast_after = 5e-324; }},
      {"lost_after", [](TrackerParams& p) { p.lost_after = 1e308; }},
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
