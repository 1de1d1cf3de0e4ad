// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/wall_throttle.hpp"

#include <gtest/gtest.h>

namespace prf_ros {
namespace {

TEST(WallThrottle, LetsOneLineThroughInAPeriod) {
  WallThrottle hour(std::chrono::hours(1));
  EXPECT_TRUE(hour.is_due());
  EXPECT_FALSE(hour.is_due());
  WallThrottle none(std::chrono::seconds(0));
  EXPECT_TRUE(none.is_due());
  EXPECT_TRUE(none.is_due());
}

TEST(WallThrottle, OfOneReasonHidesNoOther) {
  WallThrottles told;
  EXPECT_TRUE(told.is_due("forecast silent"));
  EXPECT_FALSE(told.is_due("forecast silent"));
  EXPECT_TRUE(told.is_due("planner silent"));
}

}  // namespace
}  // namespace prf_ros
