// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/setpoint_limiter.hpp"

#include <gtest/gtest.h>

#include <random>

#include "scenario.hpp"

namespace prf_decision {
namespace {

constexpr CatchUpParams kCatchUp{0.2, 0.5, 0.1};

MovingPose swaying(double t) {
  MovingPose at;
  at.pose.position = {0.6, 0.1 * std::sin(2.4 * t), 0.5};
  at.linear_velocity = {0, 0.24 * std::cos(2.4 * t), 0};
  at.pose.orientation = Eigen::AngleAxisd(0.3 * std::sin(t), Eigen::Vector3d::UnitX());
  at.angular_velocity = {0.3 * std::cos(t), 0, 0};
  return at;
}

// By a T dt / 2 with a = 0.576 m/s^2 and 0.3 rad/s^2.
TEST(SetpointLimiter, StaysWithASmoothReference) {
  Pose setpoint = swaying(0).pose;
  for (double t = 0.01; t < 5; t += 0.01) {
    const MovingPose next = limited_setpoint(setpoint, swaying(t), kCatchUp, kTickPeriod);
    EXPECT_LT((next.pose.position - swaying(t).pose.position).norm(), 0.0003);
    EXPECT_LT((next.linear_velocity - swaying(t).linear_velocity).norm(), 0.003);
    EXPECT_LT(next.pose.orientation.angularDistance(swaying(t).pose.orientation), 0.00016);
    setpoint = next.pose;
  }
}

TEST(SetpointLimiter, PassesAFractionOfTheReferencesNoise) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.001);
  Pose setpoint;
  double power = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    MovingPose reference;
    reference.pose.position.x() = noise(random);
    setpoint = limited_setpoint(setpoint, reference, kCatchUp, kTickPeriod).pose;
    power += setpoint.position.squaredNorm() / 20000;
  }
  // First-order low pass of white noise: b / (2 - b) of its power, b = 1 - exp(-dt / T).
  EXPECT_NEAR(std::sqrt(power), 0.001 * std::sqrt(0.0952 / 1.9048), 0.00002);
}

// 0.1 m at 0.2 m/s down to the last 0.021 m, which are closed at first order.
TEST(SetpointLimiter, CatchesUpWithAMovingReferenceAtItsSpeedAndThenAtFirstOrder) {
  Pose setpoint = swaying(0).pose;
  setpoint.position.x() -= 0.1;
  for (int tick = 1; tick <= 100; ++tick) {
    setpoint = limited_setpoint(setpoint, swaying(0.01 * tick), kCatchUp, kTickPeriod).pose;
    if (tick == 39) {
      EXPECT_NEAR(setpoint.position.x(), 0.5 + 39 * 0.002, 2e-6);
    }
    if (tick == 70) {
      EXPECT_NEAR(setpoint.position.x(), 0.6 - 0.022 * std::exp(-3.1), 1e-4);
    }
  }
  EXPECT_NEAR(setpoint.position.x(), 0.6, 1e-4);
}

TEST(SetpointLimiter, NeverStepsFartherThanItsSpeedAndTheReferences) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Pose setpoint;
  for (int tick = 0; tick < 20000; ++tick) {
    MovingPose reference;
    for (Eigen::Index i = 0; i < 3; ++i) {
      reference.pose.position[i] = uniform(random);
      reference.linear_velocity[i] = uniform(random);
      reference.angular_velocity[i] = uniform(random);
    }
    reference.pose.orientation =
        Eigen::Quaterniond(uniform(random), uniform(random), uniform(random), 1).normalized();
    const MovingPose next = limited_setpoint(setpoint, reference, kCatchUp, kTickPeriod);
    const double step = (next.pose.position - setpoint.position).norm();
    const double turn = next.pose.orientation.angularDistance(setpoint.orientation);
    EXPECT_LE(step, (reference.linear_velocity.norm() + 0.2) * 0.01 + 1e-12);
    EXPECT_LE(turn, (reference.angular_velocity.norm() + 0.5) * 0.01 + 1e-7);
    EXPECT_LE((next.linear_velocity - reference.linear_velocity).norm(), 0.2 + 1e-12);
    EXPECT_LE((next.angular_velocity - reference.angular_velocity).norm(), 0.5 + 1e-12);
    EXPECT_NEAR(next.pose.orientation.norm(), 1, 1e-12);
    setpoint = next.pose;
  }
}

TEST(SetpointLimiter, FeedsForwardWhatItMovesWhileCatchingUp) {
  Pose setpoint = swaying(1).pose;
  setpoint.position.x() -= 0.1;
  const MovingPose first = limited_setpoint(setpoint, swaying(1), kCatchUp, kTickPeriod);
  const Eigen::Vector3d moved = (first.pose.position - setpoint.position) / 0.01;
  EXPECT_LT((moved - first.linear_velocity).norm(), 1e-9);
}

TEST(CatchUpParams, MustBePositive) {
  EXPECT_THROW(CatchUpParams({0, 1, 1}).validate(), std::invalid_argument);
  EXPECT_THROW(CatchUpParams({1, NAN, 1}).validate(), std::invalid_argument);
  EXPECT_THROW(CatchUpParams({1, 1, 0}).validate(), std::invalid_argument);
  EXPECT_NO_THROW(kCatchUp.validate());
}

}  // namespace
}  // namespace prf_decision
