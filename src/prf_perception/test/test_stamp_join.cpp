// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/stamp_join.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace prf_perception {
namespace {

using Join = StampJoin<std::string, int>;
constexpr prf_core::Duration kMs = std::chrono::milliseconds(1);

std::vector<std::string> joined_of(Join& join) {
  std::vector<std::string> result;
  while (auto joined = join.pop()) {
    result.push_back(joined->first + (joined->second ? std::to_string(*joined->second) : "-"));
  }
  return result;
}

TEST(StampJoin, PairsEqualStampsInEitherOrder) {
  Join join(300 * kMs);
  join.push_first(10 * kMs, "a");
  EXPECT_TRUE(joined_of(join).empty());
  join.push_second(10 * kMs, 1);
  EXPECT_EQ(joined_of(join), std::vector<std::string>{"a1"});
  join.push_second(20 * kMs, 2);
  join.push_first(20 * kMs, "b");
  EXPECT_EQ(joined_of(join), std::vector<std::string>{"b2"});
}

TEST(StampJoin, JoinsNothingOnceTheOtherStreamIsPast) {
  Join join(300 * kMs);
  join.push_first(10 * kMs, "a");
  join.push_second(20 * kMs, 2);
  EXPECT_TRUE(joined_of(join).empty()) << "its stamp may be wrong";
  join.push_second(30 * kMs, 3);
  EXPECT_EQ(joined_of(join), std::vector<std::string>{"a-"});
}

// Fault 40: one camera_info far early or late -> nothing is reset, each image finds its own
TEST(StampJoin, GoesOnAfterOneWrongStampOfThePartner) {
  for (const auto wrong : {0 * kMs, 9'990 * kMs, 10'005 * kMs, 60'000 * kMs, 100'000'000 * kMs}) {
    Join join(300 * kMs);
    std::vector<std::string> found;
    for (int i = 0; i < 20; ++i) {
      join.push_first((10'000 + 33 * i) * kMs, std::to_string(i) + ":");
      for (const auto& pair : joined_of(join)) found.push_back(pair);
      if (i == 5) {
        EXPECT_TRUE(join.push_second(wrong, 99));
      }
      for (const auto& pair : joined_of(join)) found.push_back(pair);
      EXPECT_TRUE(join.push_second((10'000 + 33 * i) * kMs, i));
      for (const auto& pair : joined_of(join)) found.push_back(pair);
    }
    ASSERT_EQ(found.size(), 20U) << wrong.count();
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(found[static_cast<std::size_t>(i)], std::to_string(i) + ":" + std::to_string(i));
    }
  }
}

// Fault 40: one image old, early or doubled -> dropped; the run goes on with the next image
TEST(StampJoin, DropsOneWrongStampOfItsOwn) {
  for (const auto wrong : {0 * kMs, 5'000 * kMs, 9'990 * kMs, 10'132 * kMs, 60'000 * kMs}) {
    Join join(300 * kMs);
    for (int i = 0; i < 5; ++i) {
      join.push_first((10'000 + 33 * i) * kMs, std::to_string(i) + ":");
      join.push_second((10'000 + 33 * i) * kMs, i);
      EXPECT_EQ(joined_of(join).size(), 1U);
    }
    EXPECT_FALSE(prf_core::is_accepted(join.push_first(wrong, "wrong")));
    EXPECT_TRUE(joined_of(join).empty());
    EXPECT_EQ(join.push_first(10'165 * kMs, "next:"), prf_core::StampOrder::kNewer);
    join.push_second(10'165 * kMs, 5);
    EXPECT_EQ(joined_of(join), std::vector<std::string>{"next:5"});
  }
}

// Fault 40: a partner that comes twice -> the second one is dropped
TEST(StampJoin, KeepsTheFirstOfTwoPartners) {
  Join join(300 * kMs);
  EXPECT_TRUE(join.push_second(10 * kMs, 1));
  EXPECT_FALSE(join.push_second(10 * kMs, 2));
  join.push_first(10 * kMs, "a");
  EXPECT_EQ(joined_of(join), std::vector<std::string>{"a1"});
}

// Fault 43: garbage without end -> what is kept is bounded
TEST(StampJoin, KeepsABoundedNumber) {
  Join join(10'000 * kMs);
  std::size_t alone = 0;
  for (int i = 0; i < 1000; ++i) {
    join.push_first(i * kMs, "a");
    join.push_second(1'000'000'000 * kMs + i * kMs, i);
    alone += joined_of(join).size();
  }
  EXPECT_EQ(alone, 900U);
}

TEST(StampJoin, GivesUpOnASilentPartnerAfterItsMaxWait) {
  Join join(300 * kMs);
  join.push_first(0 * kMs, "a");
  join.push_first(300 * kMs, "b");
  EXPECT_TRUE(joined_of(join).empty());
  join.push_first(301 * kMs, "c");
  EXPECT_EQ(joined_of(join), std::vector<std::string>{"a-"});
}

TEST(StampJoin, JoinsTheSameInAnyInterleaving) {
  std::mt19937 random(5);
  std::vector<std::string> expected;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<int> turns;  // 0: the first stream's turn
    for (int i = 0; i < 20; ++i) turns.insert(turns.end(), {0, 1});
    std::shuffle(turns.begin(), turns.end(), random);
    Join join(10'000 * kMs);
    std::vector<std::string> found;
    int first = 0;
    int second = 0;
    for (const int turn : turns) {
      if (turn == 0) {
        join.push_first(first * 33 * kMs, "m" + std::to_string(first) + ":");
        ++first;
      } else {
        if (second % 7 != 3) join.push_second(second * 33 * kMs, second);  // every seventh is lost
        ++second;
      }
      for (const auto& pair : joined_of(join)) found.push_back(pair);
    }
    if (trial == 0) expected = found;
    EXPECT_EQ(found, expected);
  }
  ASSERT_EQ(expected.size(), 20u);
  EXPECT_EQ(expected[3], "m3:-");
  EXPECT_EQ(expected[4], "m4:4");
}

// Fault 11: /clock jumps back -> the third image of the new run begins it, whoever jumps first
TEST(StampJoin, StartsANewRunWhenThreeStampsInARowHaveGoneBack) {
  for (const bool partner_first : {true, false}) {
    Join join(300 * kMs);
    join.push_first(9000 * kMs, "old");
    join.push_second(9100 * kMs, 9);
    EXPECT_TRUE(joined_of(join).empty());
    std::vector<std::string> found;
    for (int i = 0; i < 4; ++i) {
      if (partner_first) join.push_second((5 + 33 * i) * kMs, i);
      const auto order = join.push_first((5 + 33 * i) * kMs, "new");
      EXPECT_EQ(order == prf_core::StampOrder::kBackwardJump, i == 2);
      if (!partner_first) join.push_second((5 + 33 * i) * kMs, i);
      for (const auto& pair : joined_of(join)) found.push_back(pair);
    }
    EXPECT_EQ(found, (std::vector<std::string>{"new2", "new3"}));
  }
}

// Fault 13: /clock leaps forward -> the third image behind the leap is the newest; no more are lost
TEST(StampJoin, FollowsAClockThatLeapt) {
  Join join(300 * kMs);
  std::vector<std::string> found;
  for (const int ms : {0, 33, 60'000, 60'033, 60'066, 60'100}) {
    join.push_first(ms * kMs, std::to_string(ms) + ":");
    join.push_second(ms * kMs, ms);
    for (const auto& pair : joined_of(join)) found.push_back(pair);
  }
  EXPECT_EQ(found, (std::vector<std::string>{"0:0", "33:33", "60066:60066", "60100:60100"}));
}

}  // namespace
}  // namespace prf_perception
