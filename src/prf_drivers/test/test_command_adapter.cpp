// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/command_adapter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>
#include <stdexcept>

namespace prf_drivers {
namespace {

using Eigen::VectorXd;
using prf_core::from_seconds;
using prf_core::Stamp;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kPeriod = 0.01;  // s

AdapterParams params(Takes takes) {
  AdapterParams result;
  result.takes = takes;
  result.period = kPeriod;
  result.delay = 0.03;
  result.gain = 10.0;
  result.command_timeout = 0.05;
  result.max_distance = 0.35;
  result.braking = 4.0;
  result.max_velocity = VectorXd::Constant(2, 0.6);
  return result;
}

Stamp tick(int i) { return from_seconds(100.0 + kPeriod * i); }

VectorXd two(double a, double b) { return Eigen::Vector2d(a, b); }

std::vector<DriverCommand> step(CommandAdapter& adapter, int i, const VectorXd& measured,
                                const VectorXd& position, const VectorXd& velocity) {
  std::vector<DriverCommand> results = adapter.add_measured(tick(i), measured);
  const auto more = adapter.add_command(tick(i), position, velocity);
  results.insert(results.end(), more.begin(), more.end());
  return results;
}

// An arm that moves with each velocity `latency` ticks after it was sent.
class DelayedArm {
 public:
  DelayedArm(std::size_t latency, const VectorXd& start)
      : waiting_(latency, VectorXd::Zero(start.size())), position_(start) {}
  void send(const VectorXd& velocity) {
    waiting_.push_back(velocity);
    position_ += kPeriod * waiting_.front();
    waiting_.pop_front();
  }
  [[nodiscard]] const VectorXd& position() const { return position_; }

 private:
  std::deque<VectorXd> waiting_;
  VectorXd position_;
};

TEST(CommandAdapter, FollowsASineThroughTheLatencyWithoutOvershoot) {
  CommandAdapter adapter(params(Takes::kVelocities));
  DelayedArm arm(2, two(0.02, 0.0));  // off by 0.02 rad at the start
  const auto wanted = [](int i) { return 0.2 * (1.0 - std::cos(2.0 * kPeriod * i)); };
  double largest = 0.0;
  for (int i = 0; i < 600; ++i) {
    const double velocity = (wanted(i) - wanted(i - 1)) / kPeriod;
    const auto sent = step(adapter, i, arm.position(), two(wanted(i), 0.0), two(velocity, 0.0));
    ASSERT_EQ(sent.size(), 1U);
    ASSERT_EQ(sent[0].hold, "");
    arm.send(sent[0].velocity);
    // A command of tick i is carried out from i + 2 to i + 3.
    if (i > 200) largest = std::max(largest, std::abs(arm.position()[0] - wanted(i - 2)));
  }
  EXPECT_LT(largest, 1e-4);
}

TEST(CommandAdapter, WaitsForTheCommandOfEachTickInWhateverOrderTheyCome) {
  CommandAdapter adapter(params(Takes::kVelocities));
  EXPECT_TRUE(adapter.add_command(tick(0), two(0, 0), two(0.1, 0)).empty());
  const auto first = adapter.add_measured(tick(0), two(0, 0));
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].stamp, tick(0));
  EXPECT_TRUE(adapter.add_measured(tick(1), two(0, 0)).empty());
  EXPECT_EQ(adapter.add_command(tick(1), two(0, 0), two(0.1, 0)).size(), 1U);
}

// Fault 50: the commands stop coming -> after command_timeout the arm brakes, then velocities of 0
TEST(CommandAdapter, BringsTheArmToRestWhenTheCommandsStop) {
  CommandAdapter adapter(params(Takes::kVelocities));
  ASSERT_EQ(step(adapter, 0, two(0, 0), two(0, 0), two(0.5, -0.1)).size(), 1U);
  std::vector<DriverCommand> held;
  for (int i = 1; i < 40; ++i) {
    const auto more = adapter.add_measured(tick(i), two(0, 0));
    held.insert(held.end(), more.begin(), more.end());
  }
  ASSERT_GE(held.size(), 30U);
  EXPECT_EQ(held.front().hold, "no command for this tick");
  EXPECT_NEAR(held.front().velocity[0], 0.5 - 4.0 * kPeriod, 1e-12);
  EXPECT_EQ(held.back().velocity, two(0, 0));
  // The first command that comes again is too late for its tick, the next one is followed.
  EXPECT_NE(step(adapter, 40, two(0, 0), two(0, 0), two(0.2, 0)).back().hold, "");
  const auto again = step(adapter, 41, two(0, 0), two(0, 0), two(0.2, 0));
  EXPECT_EQ(again.back().hold, "");
  EXPECT_NEAR(again.back().velocity[0], 0.2, 1e-12);
}

// Fault 50: the control ticks stop coming -> hold() brakes on, period by period
TEST(CommandAdapter, HoldsWithoutTicksButOnlyAfterACommand) {
  CommandAdapter adapter(params(Takes::kPositions));
  EXPECT_FALSE(adapter.hold("no tick").has_value());
  const auto sent = step(adapter, 0, two(0, 0), two(0.004, 0), two(0.4, 0));
  double position = sent.back().position[0];
  for (int i = 0; i < 20; ++i) {
    const auto held = adapter.hold("no tick");
    ASSERT_TRUE(held);
    EXPECT_EQ(held->hold, "no tick");
    EXPECT_GE(held->position[0], position);
    position = held->position[0];
  }
  EXPECT_EQ(adapter.hold("no tick")->position[0], position);
  EXPECT_NEAR(position, 0.4 * 0.4 / (2.0 * 4.0), 0.01);  // v^2 / 2a
}

// Fault 1: a command or measured joints that are not finite -> held, nothing that is not finite
// leaves
TEST(CommandAdapter, LetsNothingPassThatIsNotFinite) {
  for (const Takes takes : {Takes::kVelocities, Takes::kPositions}) {
    CommandAdapter adapter(params(takes));
    step(adapter, 0, two(0, 0), two(0, 0), two(0.1, 0));
    int i = 1;
    for (const double bad : {kNan, std::numeric_limits<double>::infinity(), 1e300}) {
      for (const auto& sent : {step(adapter, i, two(0, 0), two(bad, 0), two(0, 0)),
                               step(adapter, i + 1, two(0, 0), two(0, 0), two(0, bad)),
                               step(adapter, i + 2, two(bad, 0), two(0, 0), two(0, 0))}) {
        ASSERT_EQ(sent.size(), 1U);
        EXPECT_NE(sent[0].hold, "");
        EXPECT_TRUE(sent[0].velocity.allFinite());
        EXPECT_TRUE(sent[0].position.allFinite());
      }
      i += 3;
    }
    EXPECT_EQ(adapter.counts().refused_commands, 9U);
  }
}

// Fault 39: a command far from the measured joints -> not followed, held with the distance
TEST(CommandAdapter, DoesNotFollowACommandFarFromTheArm) {
  CommandAdapter adapter(params(Takes::kPositions));
  step(adapter, 0, two(0, 0), two(0, 0), two(0, 0));
  const auto sent = step(adapter, 1, two(0, 0), two(0.4, 0), two(0, 0));
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_NE(sent[0].hold.find("0.4 rad from the measured joints"), std::string::npos);
  EXPECT_EQ(sent[0].position, two(0, 0));
}

TEST(CommandAdapter, TakesTheShorterWayRoundInAnotherTurn) {
  CommandAdapter adapter(params(Takes::kVelocities));
  const auto sent = step(adapter, 0, two(0.01, 0), two(2.0 * M_PI, 0), two(0, 0));
  EXPECT_NEAR(sent[0].velocity[0], -0.1, 1e-9);
}

TEST(CommandAdapter, NeverExceedsTheVelocityLimits) {
  CommandAdapter adapter(params(Takes::kVelocities));
  EXPECT_EQ(step(adapter, 0, two(-0.2, 0.2), two(0, 0), two(0.6, -0.6))[0].velocity,
            two(0.6, -0.6));
  CommandAdapter positions(params(Takes::kPositions));
  step(positions, 0, two(0, 0), two(0, 0), two(0, 0));
  const auto sent = step(positions, 1, two(0, 0), two(0.3, 0), two(0.6, 0));
  EXPECT_NEAR(sent[0].position[0], 0.006, 1e-12);
}

TEST(CommandAdapter, HoldsWhileTheOperatorDoesNotAllowMotion) {
  CommandAdapter adapter(params(Takes::kVelocities));
  step(adapter, 0, two(0, 0), two(0, 0), two(0.02, 0));
  adapter.set_veto("the operator holds");
  const auto held = step(adapter, 1, two(0, 0), two(0, 0), two(0.02, 0));
  EXPECT_EQ(held[0].hold, "the operator holds");
  EXPECT_EQ(held[0].velocity, two(0, 0));
  adapter.set_veto("");
  EXPECT_EQ(step(adapter, 2, two(0, 0), two(0, 0), two(0.02, 0))[0].hold, "");
  EXPECT_EQ(adapter.counts().refused_commands, 0U);
}

// Fault 11: the clock goes back -> after three ticks a new run, nothing is sent before its first
// command
TEST(CommandAdapter, BeginsANewRunWhenTheClockGoesBack) {
  CommandAdapter adapter(params(Takes::kVelocities));
  step(adapter, 0, two(0, 0), two(0, 0), two(0.1, 0));
  for (int i = -2000; i < -1996; ++i) {
    EXPECT_TRUE(adapter.add_measured(tick(i), two(0, 0)).empty());
  }
  EXPECT_EQ(adapter.counts().new_runs, 1U);
  EXPECT_FALSE(adapter.hold("no tick").has_value());
}

// Fault 52: parameters beyond their bounds, or none for the joints -> refused by name
TEST(CommandAdapter, RefusesParametersBeyondTheirBounds) {
  const auto refused = [](auto change) {
    AdapterParams wrong = params(Takes::kVelocities);
    change(wrong);
    EXPECT_THROW(CommandAdapter{wrong}, std::invalid_argument);
  };
  refused([](AdapterParams& wrong) { wrong.period = 0.0; });
  refused([](AdapterParams& wrong) { wrong.gain = kNan; });
  refused([](AdapterParams& wrong) { wrong.delay = -0.1; });
  refused([](AdapterParams& wrong) { wrong.command_timeout = 10.0; });
  refused([](AdapterParams& wrong) { wrong.max_velocity = VectorXd(); });
  refused([](AdapterParams& wrong) { wrong.max_velocity[1] = 0.0; });
}

class FixedGuard : public MotionGuard {
 public:
  Allowance allow(const Intended& intended) override {
    rest = intended.rest;
    return allowance;
  }
  void reset() override { ++resets; }

  Allowance allowance;
  Eigen::VectorXd rest;
  int resets = 0;
};

TEST(CommandAdapter, SlowsAllJointsDownAlike) {
  for (const Takes takes : {Takes::kVelocities, Takes::kPositions}) {
    CommandAdapter adapter(params(takes));
    adapter.set_speed(0.5);
    const auto sent = step(adapter, 0, two(0, 0), two(0, 0), two(0.6, 0.3));
    ASSERT_EQ(sent.size(), 1U);
    EXPECT_NEAR(sent[0].velocity[0], 0.3, 1e-12);
    EXPECT_NEAR(sent[0].velocity[1], 0.15, 1e-12);
    const auto next = step(adapter, 1, two(0, 0), two(0.006, 0.003), two(0.6, 0.3));
    EXPECT_NEAR(next[0].position[0], takes == Takes::kPositions ? 0.003 : 0.006, 1e-12);
    EXPECT_EQ(next[0].speed, 0.5);
  }
}

TEST(CommandAdapter, HoldsAtSpeedZeroAndRefusesOtherSpeeds) {
  CommandAdapter adapter(params(Takes::kVelocities));
  (void)step(adapter, 0, two(0, 0), two(0, 0), two(0.02, 0));
  adapter.set_speed(0.0);
  const auto sent = step(adapter, 1, two(0, 0), two(0, 0), two(0.6, 0));
  EXPECT_EQ(sent[0].hold, "the operator's speed is 0");
  EXPECT_EQ(sent[0].speed, 0.0);
  for (const double bad : {-0.1, 1.1, kNan}) {
    EXPECT_THROW(adapter.set_speed(bad), std::invalid_argument);
  }
}

TEST(CommandAdapter, AsksItsGuardsWhereTheArmComesToRest) {
  auto guard = std::make_shared<FixedGuard>();
  CommandAdapter adapter(params(Takes::kVelocities), guard);
  (void)step(adapter, 0, two(1.0, 0), two(1.0, 0), two(0.4, -0.4));
  // A period and the delay, then braking: 0.04 s * 0.4 + 0.4^2 / (2 * 4).
  EXPECT_NEAR(guard->rest[0], 1.036, 1e-12);
  EXPECT_NEAR(guard->rest[1], -0.036, 1e-12);
}

TEST(CommandAdapter, ObeysItsGuards) {
  auto guard = std::make_shared<FixedGuard>();
  CommandAdapter adapter(params(Takes::kVelocities), guard);
  guard->allowance = {0.25, "near a wall", false, MotionCode::kSlowsForCollision};
  const auto slow = step(adapter, 0, two(0, 0), two(0, 0), two(0.6, 0));
  EXPECT_NEAR(slow[0].velocity[0], 0.15, 1e-12);
  EXPECT_EQ(slow[0].code, MotionCode::kSlowsForCollision);
  EXPECT_EQ(slow[0].slowed, "near a wall");
  guard->allowance = {0.0, "at a wall", true, MotionCode::kHaltsForCollision};
  for (int i = 1; i < 6; ++i) {
    const auto held = step(adapter, i, two(0, 0), two(0, 0), two(0.6, 0));
    EXPECT_EQ(held[0].hold, "at a wall");
    EXPECT_EQ(held[0].code, MotionCode::kHaltsForCollision);
    EXPECT_EQ(held[0].stamp, tick(i));
    EXPECT_NEAR(held[0].velocity[0], std::max(0.0, 0.15 - 0.04 * i), 1e-12);
  }
}

// Fault 47: a guard forbids the first motion of all -> a driver of positions is sent where the arm
// is
TEST(CommandAdapter, HoldsAnArmThatMayNotBeginWhereItIs) {
  auto guard = std::make_shared<FixedGuard>();
  CommandAdapter adapter(params(Takes::kPositions), guard);
  guard->allowance = {0.0, "not ready", true, MotionCode::kHeld};
  const auto held = step(adapter, 0, two(1.5, -0.7), two(1.51, -0.7), two(0.6, 0));
  ASSERT_EQ(held.size(), 1U);
  EXPECT_TRUE(held[0].position == two(1.5, -0.7) && held[0].velocity == two(0, 0));
}

TEST(CommandAdapter, ResetsItsGuardsWithANewRun) {
  auto guard = std::make_shared<FixedGuard>();
  CommandAdapter adapter(params(Takes::kVelocities), guard);
  for (int i = 100; i < 110; ++i) (void)step(adapter, i, two(0, 0), two(0, 0), two(0.1, 0));
  for (int i = 0; i < 5; ++i) (void)step(adapter, i, two(0, 0), two(0, 0), two(0.1, 0));
  EXPECT_EQ(guard->resets, 1);
}

}  // namespace
}  // namespace prf_drivers
