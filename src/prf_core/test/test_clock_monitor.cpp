// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/clock_monitor.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace prf_core {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const ClockBounds kBounds{seconds(1), seconds(2)};

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
  for (const Row& row :
       std::vector<Row>{{newest + ns, StampOrder::kNewer, true},
                        {newest + seconds(2), StampOrder::kNewer, true},
                        {newest + seconds(2) + ns, StampOrder::kFarAhead, false},
                        {newest, StampOrder::kDuplicate, false},
                        {newest - ns, StampOrder::kOld, false},
                        {newest - seconds(1), StampOrder::kOld, false},
                        {newest - seconds(1) - ns, StampOrder::kBackwardJump, true},
                        {Stamp{0}, StampOrder::kBackwardJump, true}}) {
    ClockMonitor clock(kBounds);
    clock.observe(newest);
    EXPECT_EQ(clock.classify(row.stamp), row.order) << row.stamp.count();
    EXPECT_EQ(clock.newest(), newest);
    EXPECT_EQ(clock.observe(row.stamp), row.order) << row.stamp.count();
    EXPECT_EQ(clock.newest(), row.becomes_newest ? row.stamp : newest) << row.stamp.count();
  }
}

TEST(ClockMonitor, WithABoundOfZeroTakesEveryStepBackForAJump) {
  ClockMonitor clock({Duration{0}});
  clock.observe(seconds(1));
  EXPECT_EQ(clock.observe(seconds(1)), StampOrder::kDuplicate);
  EXPECT_EQ(clock.observe(seconds(1) - Duration{1}), StampOrder::kBackwardJump);
}

TEST(ClockMonitor, ByDefaultFindsNothingFarAhead) {
  ClockMonitor clock;
  clock.observe(Stamp{0});
  EXPECT_EQ(clock.observe(seconds(2'000'000'000)), StampOrder::kNewer);
}

TEST(ClockMonitor, IsNotMovedByWhatIsOutOfOrder) {
  ClockMonitor clock(kBounds);
  clock.observe(seconds(10));
  for (int i = 1; i <= 20; ++i) {  // slowly back, less than the bound from one to the next
    const StampOrder order = clock.classify(seconds(10) - i * milliseconds(100));
    EXPECT_EQ(order, i <= 10 ? StampOrder::kOld : StampOrder::kBackwardJump) << i;
  }
}

TEST(ClockMonitor, GoesOnFromWhereItIsRestarted) {
  ClockMonitor clock(kBounds);
  clock.observe(seconds(10));
  clock.restart(seconds(100));
  EXPECT_EQ(clock.observe(seconds(101)), StampOrder::kNewer);
  clock.restart();
  EXPECT_EQ(clock.observe(seconds(3)), StampOrder::kNewer);
}

// One line for each message pushed: what passed, "!" when the held one was refuted.
std::string passed_through(FarAheadHold<int>& hold, const std::vector<int>& stamps_ms) {
  std::string text;
  for (const int stamp : stamps_ms) {
    const auto result = hold.push(milliseconds(stamp), stamp);
    if (result.refuted) text += "!";
    for (const auto& one : result.passed) {
      EXPECT_EQ(one.stamp, milliseconds(one.message));
      text += std::to_string(one.message);
      if (one.order == StampOrder::kFarAhead) text += "+";
      if (one.order == StampOrder::kBackwardJump) text += "<";
      text += " ";
    }
    text += "|";
  }
  return text;
}

TEST(FarAheadHold, PassesAnOrdinaryStreamAtOnce) {
  FarAheadHold<int> hold(seconds(1));
  EXPECT_EQ(passed_through(hold, {100, 133, 1133, 1100, 1133}), "100 |133 |1133 |1100 |1133 |");
}

TEST(FarAheadHold, DropsALoneStampFarAhead) {
  FarAheadHold<int> hold(seconds(1));
  EXPECT_EQ(passed_through(hold, {100, 9000, 133, 166}), "100 ||!133 |166 |");
}

TEST(FarAheadHold, FollowsAClockThatLeaptForward) {
  FarAheadHold<int> hold(seconds(1));
  EXPECT_EQ(passed_through(hold, {100, 9000, 9033, 9066}), "100 ||9000+ 9033 |9066 |");
}

TEST(FarAheadHold, HoldsTheNextOfTwoLeapsInARow) {
  FarAheadHold<int> hold(seconds(1));
  EXPECT_EQ(passed_through(hold, {100, 9000, 20000, 20010}), "100 ||9000+ |20000+ 20010 |");
}

TEST(FarAheadHold, TakesAStampJustBeforeTheHeldOneForItsConfirmation) {
  FarAheadHold<int> hold(seconds(1));
  EXPECT_EQ(passed_through(hold, {100, 9000, 8000}), "100 ||9000+ 8000 |");
  FarAheadHold<int> other(seconds(1));
  EXPECT_EQ(passed_through(other, {100, 9000, 7999, 7980}), "100 ||!|7999+ 7980 |");
}

TEST(FarAheadHold, TellsABackwardJumpAlsoAfterARefutedStamp) {
  FarAheadHold<int> hold(seconds(1));
  EXPECT_EQ(passed_through(hold, {5000, 9000, 10, 43}), "5000 ||!10< |43 |");
}

}  // namespace
}  // namespace prf_core
