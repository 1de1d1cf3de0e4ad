// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/stand_in_arm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace prf_drivers {
namespace {

using Eigen::VectorXd;

StandInArm stand_in() { return StandInArm({0.03, Eigen::Vector2d(0.6, 0.6)}); }

prf_core::Stamp tick(int i) { return prf_core::from_seconds(10.0 + 0.01 * i); }

VectorXd two(double a, double b) { return Eigen::Vector2d(a, b); }

TEST(StandInArm, IsWhereTheRealArmIsBeforeTheFirstCommand) {
  StandInArm arm = stand_in();
  EXPECT_EQ(arm.at(tick(0), two(1.0, 2.0))->position, two(1.0, 2.0));
  EXPECT_EQ(arm.at(tick(1), two(1.1, 2.0))->position, two(1.1, 2.0));
}

TEST(StandInArm, DoesWhatItIsToldAndNotWhatTheRealArmDoes) {
  StandInArm arm = stand_in();
  for (int i = 0; i < 50; ++i) {
    const auto state = arm.at(tick(i), two(1.0 + 0.1 * i, 2.0));
    ASSERT_TRUE(state.has_value());
    if (i > 5) {
      EXPECT_NEAR(state->position[0], 1.0 + 0.005 * (i - 3), 1e-9) << i;
      EXPECT_NEAR(state->velocity[0], 0.5, 1e-9);
    }
    EXPECT_TRUE(arm.command(tick(i), two(1.0 + 0.005 * i, 2.0)));
  }
}

TEST(StandInArm, IsNoFasterThanItsLimits) {
  StandInArm arm = stand_in();
  (void)arm.at(tick(0), two(0.0, 0.0));
  EXPECT_TRUE(arm.command(tick(0), two(3.0, -0.001)));
  const auto state = arm.at(tick(1), two(0.0, 0.0));
  EXPECT_NEAR(state->position[0], 0.006, 1e-12);
  EXPECT_NEAR(state->position[1], -0.001, 1e-12);
}

// Fault 1: commands or joints that are not finite -> not taken, the stand-in goes on without them
TEST(StandInArm, TakesNothingThatIsNotFinite) {
  StandInArm arm = stand_in();
  EXPECT_FALSE(arm.at(tick(0), two(std::nan(""), 0.0)).has_value());
  EXPECT_FALSE(arm.at(tick(1), VectorXd()).has_value());
  EXPECT_TRUE(arm.at(tick(2), two(0.0, 0.0)).has_value());
  EXPECT_FALSE(arm.command(tick(2), two(std::nan(""), 0.0)));
  EXPECT_FALSE(arm.command(tick(2), VectorXd()));
  EXPECT_TRUE(arm.command(tick(2), two(0.0, 0.0)));
  EXPECT_FALSE(arm.command(tick(2), two(0.1, 0.0)));
  EXPECT_TRUE(arm.at(tick(3), two(std::nan(""), 0.0)).has_value());
}

// Fault 11: the clock goes back for good -> the stand-in begins anew where the real arm is
TEST(StandInArm, BeginsAnewWithARun) {
  StandInArm arm = stand_in();
  for (int i = 1000; i < 1010; ++i) {
    (void)arm.at(tick(i), two(0.0, 0.0));
    (void)arm.command(tick(i), two(0.5, 0.0));
  }
  std::optional<StandInState> state;
  for (int i = 0; i < 4; ++i) state = arm.at(tick(i), two(2.0, 1.0));
  ASSERT_TRUE(state.has_value());
  EXPECT_EQ(state->position, two(2.0, 1.0));
}

TEST(StandInArm, RefusesParametersBeyondTheirBounds) {
  EXPECT_THROW(StandInArm({0.6, two(1, 1)}), std::invalid_argument);
  EXPECT_THROW(StandInArm({std::nan(""), two(1, 1)}), std::invalid_argument);
  EXPECT_THROW(StandInArm({0.1, VectorXd()}), std::invalid_argument);
  EXPECT_THROW(StandInArm({0.1, two(1, 0)}), std::invalid_argument);
}

}  // namespace
}  // namespace prf_drivers
