// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/clock_monitor.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace prf_core {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const ClockBounds kBounds{seconds(1), seconds(2), 3};

// A letter for each stamp: . newer, = duplicate, o old, < backward jump, a far ahead, > forward.
std::string orders(ClockMonitor& clock, const std::vector<int>& stamps_ms) {
  std::string text;
  for (const int stamp : stamps_ms) {
    const StampOrder foreseen = clock.classify(milliseconds(stamp));
    const StampOrder order = clock.observe(milliseconds(stamp));
    EXPECT_EQ(foreseen, order) << stamp;
    text += std::string(".=o<a>")[static_cast<std::size_t>(order)];
  }
  return text;
}

std::string orders(const std::vector<int>& stamps_ms) {
  ClockMonitor clock(kBounds);
  return orders(clock, stamps_ms);
}

TEST(ClockMonitor, TakesAnyFirstStamp) {
  for (const Stamp stamp : {Stamp{0}, Stamp{seconds(1'700'000'000)}, Stamp{-seconds(1)}}) {
    ClockMonitor clock(kBounds);
    EXPECT_FALSE(clock.newest());
    EXPECT_EQ(clock.observe(stamp), StampOrder::kNewer);
    EXPECT_EQ(clock.newest(), stamp);
  }
}

// Every row of the header's table, from both sides of each bound.
TEST(ClockMonitor, ClassifiesByTheNewestStamp) {
  struct Row {
    Stamp stamp;
    StampOrder order;
    bool becomes_newest;
  };
  const Duration ns{1};
  const Stamp newest = seconds(10);
  for (const Row& row : std::vector<Row>{{newest + ns, StampOrder::kNewer, true},
                                         {newest + seconds(2), StampOrder::kNewer, true},
                                         {newest + seconds(2) + ns, StampOrder::kFarAhead, false},
                                         {newest, StampOrder::kDuplicate, false},
                                         {newest - ns, StampOrder::kOld, false},
                                         {newest - seconds(1), StampOrder::kOld, false},
                                         {newest - seconds(1) - ns, StampOrder::kOld, false},
                                         {Stamp{0}, StampOrder::kOld, false}}) {
    ClockMonitor clock(kBounds);
    clock.observe(newest);
    EXPECT_EQ(clock.classify(row.stamp), row.order) << row.stamp.count();
    EXPECT_EQ(clock.newest(), newest);
    EXPECT_EQ(clock.observe(row.stamp), row.order) << row.stamp.count();
    EXPECT_EQ(clock.newest(), row.becomes_newest ? row.stamp : newest) << row.stamp.count();
  }
}

TEST(ClockMonitor, TellsFromOneStampWhetherItLiesBeyondABound) {
  ClockMonitor clock(kBounds);
  EXPECT_FALSE(clock.jumps_back(Stamp{0}) || clock.jumps_ahead(seconds(99)));
  clock.observe(seconds(10));
  EXPECT_FALSE(clock.jumps_back(seconds(9)) || clock.jumps_ahead(seconds(12)));
  EXPECT_TRUE(clock.jumps_back(seconds(9) - Duration{1}));
  EXPECT_TRUE(clock.jumps_ahead(seconds(12) + Duration{1}));
}

// Fault 11: the clock jumps back -> believed at the third message in a row, there a new run begins
TEST(ClockMonitor, BelievesABackwardJumpThatSeveralStampsConfirm) {
  EXPECT_EQ(orders({9000, 9010, 0, 10, 20, 30}), "..oo<.");
  EXPECT_EQ(orders({9000, 0, 2000, 4000, 6000}), ".oo<.");
  ClockMonitor at_once({seconds(1), seconds(2), 1});
  EXPECT_EQ(orders(at_once, {9000, 0, 10}), ".<.");
}

// Fault 13: the clock leaps forward -> followed from the third message in a row
TEST(ClockMonitor, FollowsAForwardJumpThatSeveralStampsConfirm) {
  EXPECT_EQ(orders({0, 10, 9000, 9010, 9020, 9030}), "..aa>.");
}

TEST(ClockMonitor, TakesAJumpOnlyFromStampsInOrderAndInARow) {
  EXPECT_EQ(orders({9000, 0, 10, 9010, 20, 30, 9020}), ".oo.oo.");  // one in order between
  EXPECT_EQ(orders({9000, 0, 10, 8990, 20, 30, 9010}), ".ooooo.");  // also a slightly late one
  EXPECT_EQ(orders({9000, 0, 10, 9000, 20, 30, 9010}), ".oo=oo.");  // also a duplicate
  EXPECT_EQ(orders({9000, 30, 20, 10, 20, 30}), ".oooo<");          // falling
  EXPECT_EQ(orders({9000, 0, 0, 0, 0, 10, 10, 20}), ".oooooo<");    // the same again
  EXPECT_EQ(orders({9000, 0, 2001, 4002, 6003}), ".oooo");          // too far apart
  EXPECT_EQ(orders({9000, 0, 20000, 10, 20010, 20}), ".oaoao");     // now back, now ahead
  EXPECT_EQ(orders({9000, 12000, 15000, 18000, 21000}), ".aaaa");   // no two agree
  EXPECT_EQ(orders({9000, 20000, 20010, 9010, 20020, 20030, 9020}), ".aa.aa.");
}

// Stamps of a stream with a step of 10 ms, and then `more`.
std::vector<int> steady(int count, const std::vector<int>& more) {
  std::vector<int> stamps;
  for (int i = 0; i < count; ++i) stamps.push_back(10 * i);
  stamps.insert(stamps.end(), more.begin(), more.end());
  return stamps;
}

std::string after_steady(const std::vector<int>& more) {
  return orders(steady(20, more)).substr(20);
}

// Fault 40: one stamp 0.05 to 2 s early -> it alone is dropped, the stream's own cost nothing
TEST(ClockMonitor, DropsOneEarlyStampAndKeepsTheStreamsOwn) {
  for (const int early : {51, 300, 1000, 2000}) {
    EXPECT_EQ(after_steady({190 + early, 200, 210, 220}), "a...") << early;
    EXPECT_EQ(after_steady({190 + early, 190 + early, 190 + early, 200}), "aaa.") << "the same";
    EXPECT_EQ(after_steady({190 + early, 200, 200 + early, 210}), "a.a.") << "an early copy";
    EXPECT_EQ(after_steady({190 + early, 189 + early, 200}), early > 51 ? "aa." : "a.o")
        << "falling";
  }
  EXPECT_EQ(after_steady({240, 250}), "..") << "five steps";
}

TEST(ClockMonitor, GoesOnAfterAGapAtTheCostOfOneMessage) {
  for (const int gap : {60, 500, 1990}) {
    EXPECT_EQ(after_steady({190 + gap, 200 + gap, 210 + gap}), "a..") << gap;
  }
  EXPECT_EQ(after_steady({2191, 2201, 2211, 2221}), "aa>.") << "a leap";
}

TEST(ClockMonitor, TakesAStreamWithManyGapsAsItIs) {
  EXPECT_EQ(after_steady({490, 500, 800, 810, 1110, 1120}), "a.....");
  EXPECT_EQ(orders(steady(8, {300, 310})).substr(8), "..") << "too few steps known";
  std::vector<int> slow;
  for (int i = 0; i < 20; ++i) slow.push_back(300 * i);
  slow.push_back(300 * 19 + 1500);
  EXPECT_EQ(orders(slow), std::string(21, '.'));
  std::vector<int> fast;
  for (int i = 0; i < 20; ++i) fast.push_back(i);
  fast.insert(fast.end(), {39, 40});
  EXPECT_EQ(orders(fast).substr(20), "..") << "20 ms are never early";
  fast[20] = 40;
  fast[21] = 41;
  EXPECT_EQ(orders(fast).substr(20), "a.");
}

TEST(ClockMonitor, TakesAStampBeforeAndOneBeyondForNoRow) {
  ClockMonitor clock({milliseconds(100), seconds(2), 3});
  EXPECT_EQ(orders(clock, steady(20, {80, 260, 270})).substr(20), "oa.");
}

TEST(ClockMonitor, CanTakeEveryLaterStampForTheNextOne) {
  ClockMonitor clock({seconds(1), Duration::max(), 3});
  EXPECT_EQ(clock.observe(Stamp{0}), StampOrder::kNewer);
  EXPECT_EQ(clock.observe(seconds(2'000'000'000)), StampOrder::kNewer);
}

TEST(ClockMonitor, GoesOnFromWhereItIsRestarted) {
  ClockMonitor clock(kBounds);
  EXPECT_EQ(orders(clock, {90000, 0, 10}), ".oo");
  clock.restart(seconds(100));
  EXPECT_EQ(orders(clock, {20, 101000}), "o.");
  clock.restart();
  EXPECT_EQ(orders(clock, {3000}), ".");
}

// A stream with a stamp each 10 ms in which single messages are wrong. `wrong` gives their stamp.
class Disturbed : public testing::TestWithParam<unsigned> {
 protected:
  int uniform(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }

  // Late or early by up to an hour, the same again, or what a delayed copy of the stream brings.
  int wrong(int now) {
    switch (uniform(0, 4)) {
      case 0:
        return now - uniform(1, 3'600'000);
      case 1:
        return now + uniform(2001, 3'600'000);
      case 2:
        return now;
      case 3:
        return now - 1500;
      default:
        return now + 2500;
    }
  }

  std::mt19937 random_{GetParam()};
};

// Fault 40: one message late, early or doubled -> it is dropped, no new run begins, all others
// count
TEST_P(Disturbed, LosesNoMessageInOrderToSingleWrongOnes) {
  ClockMonitor clock(kBounds);
  for (int i = 0; i < 1000; ++i) {
    const int now = 10'000'000 + 10 * i;
    ASSERT_EQ(clock.observe(milliseconds(now)), StampOrder::kNewer) << i;
    const int wrong_ones = uniform(0, 2);  // in a row
    for (int k = 0; k < wrong_ones; ++k) {
      const StampOrder order = clock.observe(milliseconds(wrong(now)));
      ASSERT_FALSE(is_accepted(order)) << i;
    }
  }
}

// Fault 40: single stamps up to 2 s early -> dropped, all others count
TEST_P(Disturbed, LosesNoMessageInOrderToSingleEarlyOnes) {
  ClockMonitor clock(kBounds);
  for (int i = 0; i < 1000; ++i) {
    const int now = 10'000'000 + 10 * i;
    ASSERT_EQ(clock.observe(milliseconds(now)), StampOrder::kNewer) << i;
    if (i < 10 || uniform(0, 3) > 0) continue;
    ASSERT_EQ(clock.observe(milliseconds(now + uniform(51, 2000))), StampOrder::kFarAhead) << i;
  }
}

TEST_P(Disturbed, FollowsEveryJumpOfAsManyStampsAsItNeeds) {
  const int confirmations = uniform(1, 6);
  ClockMonitor clock({seconds(1), seconds(2), confirmations});
  int now = 10'000'000;
  clock.observe(milliseconds(now));
  for (int i = 0; i < 100; ++i) {
    const bool back = uniform(0, 1) == 0;
    now += back ? -uniform(20'000, 1'000'000) : uniform(20'000, 1'000'000);
    for (int k = 1; k <= confirmations; ++k) {
      now += uniform(1, 2000);
      const StampOrder order = clock.observe(milliseconds(now));
      ASSERT_EQ(is_accepted(order), k == confirmations) << k << " of " << confirmations;
      if (k < confirmations) continue;
      ASSERT_EQ(order, back ? StampOrder::kBackwardJump : StampOrder::kForwardJump);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Disturbed, testing::Range(0u, 50u));

}  // namespace
}  // namespace prf_core
