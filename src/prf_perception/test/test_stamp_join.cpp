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
  EXPECT_EQ(joined_of(join), std::vector<std::string>{"a-"});
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

TEST(StampJoin, StartsANewRunWhenStampsGoBack) {
  for (const bool partner_first : {true, false}) {
    Join join(300 * kMs);
    join.push_first(9000 * kMs, "old");
    join.push_second(9100 * kMs, 9);
    EXPECT_EQ(joined_of(join), std::vector<std::string>{"old-"});
    if (partner_first) {
      EXPECT_TRUE(join.push_second(5 * kMs, 1));
      EXPECT_TRUE(join.push_first(5 * kMs, "new"));
    } else {
      EXPECT_TRUE(join.push_first(5 * kMs, "new"));
      EXPECT_TRUE(joined_of(join).empty());
      EXPECT_TRUE(join.push_second(5 * kMs, 1));
    }
    EXPECT_EQ(joined_of(join), std::vector<std::string>{"new1"});
  }
}

}  // namespace
}  // namespace prf_perception
