// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/stream_joiner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "joiner.hpp"

namespace prf_core {
namespace {

using std::chrono::milliseconds;

TEST(StreamJoiner, JoinsEqualStampsInEitherOrder) {
  Joiner joiner = joiner_with(milliseconds(300));
  primary(joiner, 10);
  EXPECT_EQ(decided(joiner), "");
  secondary(joiner, 10);
  EXPECT_EQ(decided(joiner), "10=10 ");
  secondary(joiner, 20);
  EXPECT_EQ(decided(joiner), "");
  primary(joiner, 20);
  EXPECT_EQ(decided(joiner), "20=20 ");
}

TEST(StreamJoiner, DecidesAloneOnceALaterSecondaryHasCome) {
  Joiner joiner = joiner_with(milliseconds(300));
  primary(joiner, 10);
  secondary(joiner, 20);
  EXPECT_EQ(decided(joiner), "10=- ");
  joiner.push_primary(milliseconds(20) - Duration{1}, 19);
  EXPECT_FALSE(joiner.pop()->secondary);
  EXPECT_EQ(secondary(joiner, 20), StampOrder::kDuplicate);
  primary(joiner, 20);
  EXPECT_EQ(decided(joiner), "20=20 ");
}

TEST(StreamJoiner, GivesUpOnASilentStreamUntilItComesAgain) {
  Joiner joiner = joiner_with(milliseconds(30));
  for (const int ms : {0, 10, 20, 30}) primary(joiner, ms);
  EXPECT_EQ(decided(joiner), "");
  primary(joiner, 31);
  EXPECT_EQ(decided(joiner), "0=- 10=- 20=- 30=- 31=- ");
  EXPECT_TRUE(joiner.is_silent());
  primary(joiner, 40);
  EXPECT_EQ(decided(joiner), "40=- ");
  EXPECT_EQ(secondary(joiner, 40), StampOrder::kOld);  // too late, but it is heard
  primary(joiner, 50);
  EXPECT_EQ(decided(joiner), "");
  secondary(joiner, 50);
  EXPECT_EQ(decided(joiner), "50=50 ");
}

TEST(StreamJoiner, WaitsAgainInANewRun) {
  Joiner joiner = joiner_with(milliseconds(30));
  for (const int ms : {5000, 5040}) primary(joiner, ms);
  EXPECT_EQ(decided(joiner), "5000=- 5040=- ");
  for (const int ms : {-20, -10, 0}) primary(joiner, ms);
  EXPECT_FALSE(joiner.is_silent());
  EXPECT_EQ(decided(joiner), "");
  EXPECT_EQ(secondary(joiner, 0), StampOrder::kNewer);
  EXPECT_EQ(secondary(joiner, 10), StampOrder::kNewer);  // no longer too late
}

TEST(StreamJoiner, GivesUpWhenMorePrimariesWaitThanItsCapacity) {
  Joiner joiner({Duration::max(), {}, 3});
  for (const int ms : {1, 2, 3}) primary(joiner, ms);
  EXPECT_EQ(decided(joiner), "");
  primary(joiner, 4);
  EXPECT_EQ(decided(joiner), "1=- ");
  EXPECT_EQ(joiner.waiting(), 3u);
}

TEST(StreamJoiner, JoinsEveryPrimaryOfOneStamp) {
  Joiner joiner = joiner_with(milliseconds(300));
  primary(joiner, 10);
  EXPECT_EQ(primary(joiner, 10), StampOrder::kDuplicate);
  secondary(joiner, 10);
  EXPECT_EQ(decided(joiner), "10=10 10=10 ");
}

TEST(StreamJoiner, JoinsByAKeyThatThePrimaryNames) {
  Joiner joiner = joiner_with(Duration::max());
  secondary(joiner, 100);
  joiner.push_primary(milliseconds(170), milliseconds(100), 170);
  joiner.push_primary(milliseconds(270), milliseconds(200), 270);
  EXPECT_EQ(decided(joiner), "170=100 ");
  secondary(joiner, 300);
  EXPECT_EQ(decided(joiner), "270=- ");
}

TEST(StreamJoiner, AdvancesWithoutAMessage) {
  Joiner joiner = joiner_with(milliseconds(30));
  primary(joiner, 0);
  EXPECT_EQ(joiner.advance(milliseconds(31)), StampOrder::kNewer);
  EXPECT_EQ(decided(joiner), "0=- ");
  for (const int ms : {-2020, -2010}) EXPECT_EQ(joiner.advance(milliseconds(ms)), StampOrder::kOld);
  EXPECT_EQ(joiner.advance(milliseconds(-2000)), StampOrder::kBackwardJump);
  EXPECT_EQ(decided(joiner), "");
  primary(joiner, -2000);
  secondary(joiner, -2000);
  EXPECT_EQ(decided(joiner), "*-2000=-2000 ");
}

// Two runs: each stream goes back from 5000 to 0 in its own time.
struct Streams {
  std::vector<int> primaries;
  std::vector<int> secondaries;
};

std::string deliver(const Streams& streams, const std::vector<bool>& turns) {
  Joiner joiner = joiner_with(Duration::max());
  std::string text;
  auto next_primary = streams.primaries.begin();
  auto next_secondary = streams.secondaries.begin();
  for (const bool primary_next : turns) {
    primary_next ? primary(joiner, *next_primary++) : secondary(joiner, *next_secondary++);
    text += decided(joiner);
  }
  return text;
}

TEST(StreamJoiner, GivesTheSameInEveryOrderOfTwoStreams) {
  const Streams streams{{10, 20, 30, 40, 50, 60}, {10, 30, 40, 45, 60, 70}};
  std::vector<bool> turns(12, false);
  std::fill(turns.end() - 6, turns.end(), true);
  int orders = 0;
  do {
    ASSERT_EQ(deliver(streams, turns), "10=10 20=- 30=30 40=40 50=- 60=60 ");
    ++orders;
  } while (std::next_permutation(turns.begin(), turns.end()));
  EXPECT_EQ(orders, 924);
}

// What the old run still gives depends on when the clock goes back; the new run never does.
TEST(StreamJoiner, GivesTheSameNewRunInEveryOrderOfTwoStreamsThatGoBack) {
  const std::string old_run = "5000=5000 5010=- 5030=5030 ";
  const std::string new_run = "*20=20 30=- 40=40 ";
  const Streams streams{{5000, 5010, 5030, 0, 10, 20, 30, 40},
                        {5000, 5020, 5030, 10, 20, 25, 40, 45}};
  std::vector<bool> turns(16, false);
  std::fill(turns.end() - 8, turns.end(), true);
  int orders = 0;
  do {
    const std::string text = deliver(streams, turns);
    const std::size_t begin = text.find('*');
    ASSERT_EQ(text.substr(std::min(begin, text.size())), new_run);
    ASSERT_EQ(old_run.rfind(text.substr(0, begin), 0), 0u) << text;
    ++orders;
  } while (std::next_permutation(turns.begin(), turns.end()));
  EXPECT_EQ(orders, 12870);
}

TEST(StreamJoiner, GivesTheSameWheneverNoStreamLagsByMoreThanMaxWait) {
  std::mt19937 random(1);
  std::string expected;
  for (int order = 0; order < 200; ++order) {
    Joiner joiner = joiner_with(milliseconds(300));
    std::string text;
    int primaries = 0;
    int secondaries = 0;
    while (primaries < 500 || secondaries < 500) {
      const int lead = primaries - secondaries;
      const bool primary_next =
          secondaries == 500 || lead <= -25 || (lead < 25 && primaries < 500 && random() % 2 == 0);
      if (primary_next) {
        primary(joiner, 10 * ++primaries);
      } else if (++secondaries % 7 != 0) {
        secondary(joiner, 10 * secondaries);
      }
      text += decided(joiner);
    }
    if (order == 0) expected = text;
    ASSERT_EQ(text, expected) << order;
  }
  EXPECT_EQ(std::count(expected.begin(), expected.end(), ' '), 500);
  EXPECT_EQ(std::count(expected.begin(), expected.end(), '-'), 71);
}

}  // namespace
}  // namespace prf_core
