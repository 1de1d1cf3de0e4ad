// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/setpoint_limiter.hpp"

#include <gtest/gtest.h>

#include <random>

#include "scenario.hpp"

namespace prf_decision {
namespace {

constexpr CatchUpSpeed kSpeed{0.2, 0.5};

MovingPose swaying(double t) {
  MovingPose at;
  at.pose.position = {0.6, 0.1 * std::sin(2.4 * t), 0.5};
  at.linear_velocity = {0, 0.24 * std::cos(2.4 * t), 0};
  at.pose.orientation = Eigen::AngleAxisd(0.3 * std::sin(t), Eigen::Vector3d::UnitX());
  at.angular_velocity = {0.3 * std::cos(t), 0, 0};
  return at;
}

TEST(SetpointLimiter, EqualsASmoothReferenceOnceCaughtUp) {
  Pose setpoint = swaying(0).pose;
  for (double t = 0.01; t < 5; t += 0.01) {
    const MovingPose next = limited_setpoint(setpoint, swaying(t), kSpeed, kTickPeriod);
    EXPECT_EQ(next.pose.position, swaying(t).pose.position);
    EXPECT_EQ(next.linear_velocity, swaying(t).linear_velocity);
    EXPECT_EQ(next.pose.orientation.coeffs(), swaying(t).pose.orientation.coeffs());
    setpoint = next.pose;
  }
}

TEST(SetpointLimiter, CatchesUpWithAMovingReferenceInTheTimeTheGapTakes) {
  Pose setpoint = swaying(0).pose;
  setpoint.position.x() -= 0.1;
  int ticks = 0;
  for (double t = 0.01; setpoint.position.x() != 0.6; t += 0.01) {
    setpoint = limited_setpoint(setpoint, swaying(t), kSpeed, kTickPeriod).pose;
    ASSERT_LT(++ticks, 60);
  }
  EXPECT_NEAR(ticks, 50, 1);  // 0.1 m at 0.2 m/s
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
    const MovingPose next = limited_setpoint(setpoint, reference, kSpeed, kTickPeriod);
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
  const MovingPose first = limited_setpoint(setpoint, swaying(1), kSpeed, kTickPeriod);
  const Eigen::Vector3d moved = (first.pose.position - setpoint.position) / 0.01;
  EXPECT_LT((moved - first.linear_velocity).norm(), 1e-9);
}

TEST(CatchUpSpeed, MustBePositive) {
  EXPECT_THROW(CatchUpSpeed({0, 1}).validate(), std::invalid_argument);
  EXPECT_THROW(CatchUpSpeed({1, NAN}).validate(), std::invalid_argument);
  EXPECT_NO_THROW(kSpeed.validate());
}

}  // namespace
}  // namespace prf_decision
