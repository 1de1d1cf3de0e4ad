// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/joint_range_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace prf_drivers {
namespace {

Allowance ask(double from, double rest) {
  const double none = std::numeric_limits<double>::infinity();
  const JointRangeGuard guard({Eigen::Vector2d(-none, 0.5), Eigen::Vector2d(none, 5.5)},
                              {"wheel", "hinge"});
  return guard.allow(
      {prf_core::Stamp(1), Measured(Eigen::Vector2d(9.0, from)), Eigen::Vector2d(99.0, rest)});
}

// Fault 37: a joint that would leave its bounds -> held, with the joint's name
TEST(JointRangeGuard, HoldsAJointThatWouldLeaveItsBounds) {
  EXPECT_FALSE(ask(5.3, 5.49).hold);
  const Allowance held = ask(5.3, 5.51);
  EXPECT_TRUE(held.hold);
  EXPECT_EQ(held.code, MotionCode::kJointBound);
  EXPECT_EQ(held.why, "hinge would leave its bounds");
  EXPECT_TRUE(ask(0.6, 0.49).hold);
}

TEST(JointRangeGuard, CountsTurnsAsTheSamePlace) {
  EXPECT_FALSE(ask(5.3 - 2.0 * M_PI, 5.4 - 2.0 * M_PI).hold);
  EXPECT_TRUE(ask(5.3 - 2.0 * M_PI, 5.51 - 2.0 * M_PI).hold);
}

TEST(JointRangeGuard, LetsAJointComeBack) {
  EXPECT_FALSE(ask(5.7, 5.65).hold);
  EXPECT_TRUE(ask(5.65, 5.7).hold);
}

TEST(JointRangeGuard, HoldsWhatIsNoNumber) { EXPECT_TRUE(ask(1.0, std::nan("")).hold); }

}  // namespace
}  // namespace prf_drivers
