// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/joint_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace prf_control {
namespace {

constexpr double kDt = 0.01;
constexpr double kRounding = 1e-11;

MotionLimits some_limits() {
  MotionLimits limits;
  limits.lower.setConstant(7, -1.0);
  limits.upper.setConstant(7, 1.5);
  limits.velocity.resize(7);
  limits.acceleration.resize(7);
  limits.lower[0] = limits.lower[6] = -std::numeric_limits<double>::infinity();
  limits.upper[0] = limits.upper[6] = std::numeric_limits<double>::infinity();
  limits.velocity << 0.6, 0.6, 0.6, 0.6, 0.8, 0.8, 0.8;
  limits.acceleration << 4.0, 3.0, 4.0, 4.0, 5.0, 5.0, 2.0;
  limits.braking = limits.acceleration;
  return limits;
}

MotionState rest(std::initializer_list<double> q) {
  MotionState state = at_rest(JointVector::Zero(7));
  std::copy(q.begin(), q.end(), state.position.data());
  return state;
}

void expect_within_limits(const MotionState& before, const MotionState& after, double dt,
                          const MotionLimits& limits) {
  const auto finite = after.position.allFinite() && after.velocity.allFinite();
  ASSERT_TRUE(finite);
  const JointVector change =
      (after.velocity - before.velocity).cwiseAbs() - limits.acceleration * dt;
  ASSERT_LE(change.maxCoeff(), kRounding);
  ASSERT_LE((after.velocity.cwiseAbs() - limits.velocity).maxCoeff(), kRounding);
  ASSERT_GE((after.position - limits.lower).minCoeff(), 0.0);
  ASSERT_GE((limits.upper - after.position).minCoeff(), 0.0);
  ASSERT_LE((after.position - before.position - dt * after.velocity).cwiseAbs().maxCoeff(),
            kRounding);
}

JointVector random_joints(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return JointVector::NullaryExpr(7, [&] { return uniform(random); });
}

TEST(ApproachSpeed, LeavesTheDistanceExactlyWhenBrakingEveryPeriod) {
  for (const double distance : {1e-9, 1e-5, 3.7e-4, 0.02, 1.3}) {
    double left = distance;
    double last = approach_speed(distance, 2.0, kDt);
    for (int i = 0; i < 1000 && left > 1e-15; ++i) {
      const double speed = approach_speed(left, 2.0, kDt);
      EXPECT_LE(last - speed, 2.0 * kDt + 1e-9) << distance;
      last = speed;
      left -= speed * kDt;
      EXPECT_GE(left, -1e-12);
    }
    EXPECT_LE(left, 1e-12) << distance;
    EXPECT_LE(last, 2.0 * kDt + 1e-9);
  }
}

TEST(StepToward, ReachesAFarGoalInAStraightLineWithoutOvershoot) {
  const MotionLimits limits = some_limits();
  const MotionState begin = rest({0.0, 0.2, -0.3, 0.1, 0.0, 0.4, 3.0});
  const MotionState goal = rest({2.0, -0.6, 0.9, 0.1, -0.7, 1.2, -1.0});
  const JointVector way = goal.position - begin.position;
  MotionState state = begin;
  double last_progress = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const MotionState next = step_toward(state, goal, kDt, limits).state;
    expect_within_limits(state, next, kDt, limits);
    state = next;
    const JointVector gone = state.position - begin.position;
    const double progress = gone.dot(way) / way.squaredNorm();
    EXPECT_LE((gone - progress * way).norm(), 1e-9);
    EXPECT_GE(progress, last_progress - 1e-12);
    EXPECT_LE(progress, 1.0 + 1e-12);
    last_progress = progress;
  }
  EXPECT_LE((state.position - goal.position).norm(), 1e-9);
  EXPECT_LE(state.velocity.norm(), 1e-9);
}

TEST(StepToward, IsNotMuchSlowerThanTheSlowestJointAloneWouldBe) {
  const MotionLimits limits = some_limits();
  const MotionState goal = rest({4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0});
  MotionState state = at_rest(JointVector::Zero(7));
  int ticks = 0;
  while ((state.position - goal.position).norm() > 1e-6 && ticks < 2000) {
    state = step_toward(state, goal, kDt, limits).state;
    ++ticks;
  }
  const double time_optimal = 4.0 / 0.6 + 0.6 / 4.0;
  EXPECT_LE(ticks * kDt, time_optimal + 0.1);
}

TEST(StepToward, MeetsAMovingGoalExactly) {
  const MotionLimits limits = some_limits();
  MotionState state = at_rest(JointVector::Zero(7));
  MotionState goal = rest({0.4, 0.4, -0.3, 0.2, 0.3, 0.3, -0.5});
  goal.velocity << 0.3, -0.05, 0.04, 0.0, -0.05, 0.05, 0.3;
  for (int i = 0; i < 400; ++i) {
    goal.position += kDt * goal.velocity;
    const MotionState next = step_toward(state, goal, kDt, limits).state;
    expect_within_limits(state, next, kDt, limits);
    state = next;
  }
  EXPECT_LE((state.position - goal.position).norm(), 1e-10);
  EXPECT_LE((state.velocity - goal.velocity).norm(), 1e-9);
}

TEST(StepToward, NamesTheJointThatMetItsVelocityLimit) {
  const MotionState goal = rest({0.1, 0.0, 0.0, 0.0, 1.4, 0.0, 0.0});
  MotionState state = at_rest(JointVector::Zero(7));
  LimitedStep step;
  for (int i = 0; i < 50; ++i) {
    step = step_toward(state, goal, kDt, some_limits());
    state = step.state;
    EXPECT_EQ(step.limit, i < 15 ? Limit::kAcceleration : Limit::kVelocity) << i;
  }
  EXPECT_EQ(step.limit, Limit::kVelocity);
  EXPECT_EQ(step.joint, 4);
  EXPECT_DOUBLE_EQ(step.bound, 0.8);
  EXPECT_GT(step.asked, 0.8);
}

TEST(StepToward, BrakesBeforeAPositionLimitThatTheGoalLiesBeyond) {
  const MotionLimits limits = some_limits();
  MotionState goal = rest({0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  goal.velocity[1] = 0.5;
  MotionState state = at_rest(JointVector::Zero(7));
  bool met = false;
  for (int i = 0; i < 800; ++i) {
    const LimitedStep step = step_toward(state, goal, kDt, limits);
    expect_within_limits(state, step.state, kDt, limits);
    state = step.state;
    met = met || (step.limit == Limit::kPosition && step.joint == 1);
  }
  EXPECT_TRUE(met);
  EXPECT_NEAR(state.position[1], 1.5, 1e-3);
}

TEST(StepToward, KeepsEveryLimitForRandomGoalsAndPeriods) {
  const MotionLimits limits = some_limits();
  std::mt19937 random(1);
  std::uniform_int_distribution<int> periods(1, 4);
  std::uniform_int_distribution<int> patience(1, 200);
  MotionState state = at_rest(JointVector::Zero(7));
  for (int goals = 0; goals < 400; ++goals) {
    MotionState goal{random_joints(random, 2.0), random_joints(random, 1.0)};
    for (int i = patience(random); i > 0; --i) {
      const double dt = 0.01 * periods(random);
      goal.position += dt * goal.velocity;
      const MotionState next = step_toward(state, goal, dt, limits).state;
      expect_within_limits(state, next, dt, limits);
      if (HasFatalFailure()) return;
      state = next;
    }
  }
}

// Goals that change in full motion are approached from the side, without circling around them.
TEST(StepToward, SettlesSoonOnAGoalGivenInFullMotion) {
  MotionLimits limits = some_limits();
  std::mt19937 random(2);
  MotionState state = at_rest(JointVector::Zero(7));
  for (int goals = 0; goals < 300; ++goals) {
    MotionState goal = at_rest(JointVector::Zero(7));
    goal.position = random_joints(random, 0.9);
    for (int i = 0; i < 80; ++i) state = step_toward(state, goal, kDt, limits).state;

    const JointVector change = random_joints(random, goals % 2 == 0 ? 0.05 : 0.9);
    goal.position = (state.position + change).cwiseMax(-0.9).cwiseMin(1.4);
    const JointVector way = (goal.position - state.position).cwiseAbs();
    const double fastest = way.cwiseQuotient(limits.velocity).maxCoeff();
    const int ticks = static_cast<int>((fastest + 1.2) / kDt);
    for (int i = 0; i < ticks; ++i) state = step_toward(state, goal, kDt, limits).state;
    ASSERT_LE((state.position - goal.position).norm(), 1e-6) << goals;
    ASSERT_LE(state.velocity.norm(), 1e-3) << goals;
  }
}

TEST(StepToRest, KeepsTheDirectionAndStopsAsFastAsAllowed) {
  const MotionLimits limits = some_limits();
  MotionState state = at_rest(JointVector::Zero(7));
  state.velocity << 0.5, -0.3, 0.0, 0.1, 0.2, -0.6, 0.4;
  const JointVector direction = state.velocity.normalized();
  int ticks = 0;
  while (state.velocity.norm() > 0.0 && ticks < 100) {
    const MotionState next = step_to_rest(state, kDt, limits).state;
    expect_within_limits(state, next, kDt, limits);
    EXPECT_LE((next.velocity - next.velocity.dot(direction) * direction).norm(), 1e-12);
    state = next;
    ++ticks;
  }
  EXPECT_EQ(ticks, 20);  // joint 7: 0.4 rad/s at 2 rad/s^2
  EXPECT_EQ(step_to_rest(state, kDt, limits).state.position, state.position);
}

// Fault 52: an acceleration limit lowered in full motion -> the arm still stops with `braking`,
// before its position limits
TEST(StepToRest, BrakesWithTheBrakingLimitAndSpeedsUpWithTheAcceleration) {
  MotionLimits limits = some_limits();
  limits.acceleration.setConstant(7, 0.1);
  limits.braking.setConstant(7, 4.0);
  MotionState state = at_rest(JointVector::Zero(7));
  state.position[1] = 1.45;  // 0.05 rad from its limit
  state.velocity << 0.5, 0.5, 0.0, 0.1, 0.2, -0.6, 0.4;
  for (int i = 0; i < 15; ++i) {
    const MotionState next = step_to_rest(state, kDt, limits).state;
    ASSERT_LE((next.velocity - state.velocity).cwiseAbs().maxCoeff(), 4.0 * kDt + kRounding);
    ASSERT_LE(next.position[1], 1.5);
    state = next;
  }
  EXPECT_LE(state.velocity.norm(), 1e-12);
  for (int i = 0; i < 3; ++i) {
    const MotionState next = step_toward(state, rest({1, 1, 1, 1, 1, 1, 1}), kDt, limits).state;
    ASSERT_LE((next.velocity - state.velocity).cwiseAbs().maxCoeff(), 0.1 * kDt + kRounding);
    state = next;
  }
}

// Fault 37: a joint outside its limits -> it may come back at its own pace or stay, and never goes
// farther out
TEST(JointMotion, ComesBackFromOutsideTheLimitsWithoutAJump) {
  const MotionLimits limits = some_limits();
  MotionState state = at_rest(JointVector::Zero(7));
  state.position[3] = 1.7;
  EXPECT_EQ(step_to_rest(state, kDt, limits).state.position, state.position);
  const VelocityRange range = allowed_velocities(state, kDt, limits);
  EXPECT_EQ(range.upper[3], 0.0);
  EXPECT_LT(range.lower[3], 0.0);
  MotionState outward = rest({0, 0, 0, 5.0, 0, 0, 0});
  EXPECT_EQ(step_toward(state, outward, kDt, limits).state.position[3], 1.7);
  double farthest = 1.7;
  for (int i = 0; i < 200; ++i) {
    const MotionState next = step_toward(state, at_rest(JointVector::Zero(7)), kDt, limits).state;
    ASSERT_LE(next.position[3], farthest);
    ASSERT_LE(std::abs(next.position[3] - state.position[3]), 0.6 * kDt + kRounding);
    ASSERT_LE(std::abs(next.velocity[3] - state.velocity[3]), 4.0 * kDt + kRounding);
    farthest = next.position[3];
    state = next;
  }
  EXPECT_LE(farthest, 1.5);
}

// Fault 43: state, goal or period that is not finite -> refused
TEST(JointMotion, RefusesInputThatIsNotFinite) {
  const MotionLimits limits = some_limits();
  MotionState bad = at_rest(JointVector::Zero(7));
  bad.position[3] = std::nan("");
  EXPECT_THROW((void)step_toward(bad, at_rest(JointVector::Zero(7)), kDt, limits),
               std::invalid_argument);
  EXPECT_THROW((void)step_toward(at_rest(JointVector::Zero(7)), bad, kDt, limits),
               std::invalid_argument);
  EXPECT_THROW((void)step_to_rest(bad, kDt, limits), std::invalid_argument);
  for (const double dt : {0.0, -0.01, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(
        (void)step_toward(at_rest(JointVector::Zero(7)), at_rest(JointVector::Zero(7)), dt, limits),
        std::invalid_argument);
  }
}

TEST(MotionLimits, RefuseImpossibleValues) {
  MotionLimits limits = some_limits();
  EXPECT_NO_THROW(limits.validate());
  limits.lower[2] = 1.5;
  EXPECT_THROW(limits.validate(), std::invalid_argument);
  limits = some_limits();
  limits.velocity[2] = 0.0;
  EXPECT_THROW(limits.validate(), std::invalid_argument);
  limits = some_limits();
  limits.acceleration[2] = std::nan("");
  EXPECT_THROW(limits.validate(), std::invalid_argument);
  limits = some_limits();
  limits.braking[2] = 0.9 * limits.acceleration[2];
  EXPECT_THROW(limits.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace prf_control
