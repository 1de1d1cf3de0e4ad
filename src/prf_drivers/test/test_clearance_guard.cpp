// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/clearance_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "small_arm.hpp"

namespace prf_drivers {
namespace {

constexpr ClearanceParams kParams{0.02, 0.12};

RobotShapes shapes() { return {small_arm(), "base", kSmallArm}; }

Allowance ask(double now, double rest) {
  return allowed_by(kParams, {{"one and three", now}}, {{"one and three", rest}});
}

TEST(ClearanceGuard, SlowsDownAndHaltsWithTheDistanceAtRest) {
  EXPECT_EQ(ask(0.2, 0.13).speed, 1.0);
  const Allowance slow = ask(0.2, 0.07);
  EXPECT_FALSE(slow.hold);
  EXPECT_NEAR(slow.speed, 0.55, 1e-9);
  EXPECT_EQ(slow.code, MotionCode::kSlowsForCollision);
  const Allowance halt = ask(0.2, 0.019);
  EXPECT_TRUE(halt.hold);
  EXPECT_EQ(halt.code, MotionCode::kHaltsForCollision);
  EXPECT_EQ(halt.why, "one and three would be 19 mm apart");
}

TEST(ClearanceGuard, LetsTheArmLeave) {
  EXPECT_EQ(ask(0.01, 0.012).speed, 1.0);
  EXPECT_TRUE(ask(0.01, 0.01).hold);
}

TEST(ClearanceGuard, DoesNotTakeLeavingOneForLeavingAnother) {
  EXPECT_TRUE(allowed_by(kParams, {{"a", 0.005}}, {{"a", 0.01}, {"b", 0.015}}).hold);
}

// Fault 1: a distance that is not a number -> the arm is held
TEST(ClearanceGuard, HoldsAtADistanceThatIsNoNumber) { EXPECT_TRUE(ask(0.1, std::nan("")).hold); }

// Fault 56: a motion that would fold the arm into itself -> it is slowed down, then held
TEST(SelfCollisionGuard, HoldsTheArmOffItself) {
  SelfCollisionGuard guard(shapes(), three(0, 0, 0), kParams);
  const Measured measured(three(0.0, 1.9, 1.9));
  double speed = 1.0;
  bool held = false;
  for (double fold = 1.9; fold < 2.4; fold += 0.01) {
    const Allowance found = guard.allow({prf_core::Stamp(1), measured, three(0.0, fold, fold)});
    EXPECT_LE(found.speed, speed + 1e-9);
    speed = found.speed;
    held = held || found.hold;
    EXPECT_TRUE(found.hold || fold < 2.3) << fold;
  }
  EXPECT_TRUE(held);
}

TEST(SelfCollisionGuard, LeavesOutWhatTheReadyPostureLetsTouch) {
  const SelfCollisionGuard guard(shapes(), three(0.0, 2.4, 2.4), kParams);
  EXPECT_EQ(guard.ignored(), std::vector<std::string>{"one and three"});
}

// Fault 56: a motion out of the workspace or into a forbidden box -> held before, free to leave
TEST(BoxGuard, HoldsTheArmInsideAndOutside) {
  const Box workspace{{-1.2, -1.2, -1.0}, {1.2, 1.2, 1.0}};
  BoxGuard guard(shapes(), workspace, {{{0.9, 0.4, -0.1}, {1.0, 0.6, 0.1}}}, kParams);
  const auto ask = [&guard](const Eigen::VectorXd& from, const Eigen::VectorXd& rest) {
    return guard.allow({prf_core::Stamp(1), Measured(from), rest});
  };
  EXPECT_EQ(ask(three(0.0, 1.0, 1.0), three(0.0, 1.1, 1.0)).speed, 1.0);
  EXPECT_LT(ask(three(0.2, 0.2, 0.2), three(0.1, 0.1, 0.1)).speed, 1.0);
  const Allowance into = ask(three(0.6, 0.0, 0.0), three(0.47, 0.0, 0.0));
  EXPECT_TRUE(into.hold);
  EXPECT_EQ(into.why.find("three and forbidden box 1"), 0U);
  EXPECT_FALSE(ask(three(0.62, 0.0, 0.0), three(0.7, 0.0, 0.0)).hold);
}

TEST(BoxGuard, RefusesBoxesThatAreNone) {
  EXPECT_THROW((void)boxes_from("workspace", {0, 0, 0, 1, 1}), std::invalid_argument);
  EXPECT_THROW((void)boxes_from("workspace", {0, 0, 2, 1, 1, 1}), std::invalid_argument);
  EXPECT_THROW((void)boxes_from("forbidden", {0, 0, 0, 1, 1, std::nan("")}), std::invalid_argument);
  EXPECT_EQ(boxes_from("forbidden", {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3}).size(), 2U);
  EXPECT_TRUE(boxes_from("forbidden", {}).empty());
}

TEST(ClearanceGuard, RefusesDistancesBeyondTheirBounds) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ClearanceParams& bad :
       {ClearanceParams{-0.1, 0.1}, {0.1, 0.1}, {0.1, 0.05}, {0.1, 2.0}, {nan, 0.1}, {0.1, nan}}) {
    EXPECT_THROW(bad.validate(), std::invalid_argument);
  }
}

}  // namespace
}  // namespace prf_drivers
