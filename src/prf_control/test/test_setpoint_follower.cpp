// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/setpoint_follower.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "follower_limits.hpp"
#include "prf_control/nearest_pose.hpp"

namespace prf_control {
namespace {

using jaco_kinematics::forward;
using jaco_kinematics::jaco_joint_limits;

using Twist = Eigen::Matrix<double, 6, 1>;

// The hand on an ellipse and rocking, its velocity fed forward.
PoseSetpoint swaying(double time, double size, double frequency) {
  const double phase = frequency * time;
  PoseSetpoint setpoint;
  setpoint.hand_in_base = forward(home());
  setpoint.hand_in_base.translation() +=
      size * Eigen::Vector3d(0.4 * (std::cos(phase) - 1.0), std::sin(phase), 0.3 * std::sin(phase));
  setpoint.linear_velocity =
      size * frequency *
      Eigen::Vector3d(-0.4 * std::sin(phase), std::cos(phase), 0.3 * std::cos(phase));
  setpoint.hand_in_base.rotate(Eigen::AngleAxisd(size * std::sin(phase), Eigen::Vector3d::UnitX()));
  setpoint.angular_velocity =
      size * frequency * std::cos(phase) * setpoint.hand_in_base.linear().col(0);
  return setpoint;
}

TEST(SetpointFollower, CommandsTheSetpointExactlyWhenItMovesSlowly) {
  SetpointFollower follower(jaco(), params());
  follower.start(home());
  for (int i = 0; i < 1000; ++i) {
    const PoseSetpoint setpoint = swaying(kDt * i, 0.05, 2.4);
    const FollowerStep step = follower.follow(setpoint, kDt);
    if (i < 150) continue;  // the hand starts at rest, so it is behind at first
    ASSERT_EQ(step.goal, GoalKind::kExact);
    ASSERT_LE(step.position_deviation, 1e-6) << i;
    ASSERT_LE(step.orientation_deviation, 1e-6) << i;
    const auto error = pose_error(forward(step.motion.state.position), setpoint.hand_in_base);
    ASSERT_LE(error.norm(), 2e-6);
  }
}

TEST(SetpointFollower, CommandsTheVelocityOfTheSetpoint) {
  SetpointFollower follower(jaco(), params());
  follower.start(home());
  for (int i = 0; i < 600; ++i) {
    const PoseSetpoint setpoint = swaying(kDt * i, 0.05, 2.4);
    const MotionState command = follower.follow(setpoint, kDt).motion.state;
    if (i < 150) continue;
    const Twist twist = jaco_kinematics::jacobian(command.position) * command.velocity;
    ASSERT_LE((twist.head<3>() - setpoint.linear_velocity).norm(), 3e-3);
    ASSERT_LE((twist.tail<3>() - setpoint.angular_velocity).norm(), 3e-3);
  }
}

// Faster than the joints can: all of them slowed alike would leave the hand 71 mm behind.
TEST(SetpointFollower, KeepsTheHandOnItsWayWhereAJointIsAtItsLimit) {
  SetpointFollower follower(jaco(), params());
  follower.start(home());
  double deviation = 0;
  double turn = 0;
  int limited = 0;
  for (int i = 0; i < 1500; ++i) {
    const MotionState before = follower.state();
    const FollowerStep step = follower.follow(swaying(kDt * i, 0.12, 3.0), kDt);
    ASSERT_NO_FATAL_FAILURE(expect_within_limits(before, step.motion.state, kDt));
    if (i < 100) continue;
    ASSERT_EQ(step.goal, GoalKind::kExact);
    deviation = std::max(deviation, step.position_deviation);
    turn = std::max(turn, step.orientation_deviation);
    limited += step.motion.limit == Limit::kVelocity;
  }
  EXPECT_GT(limited, 300);
  EXPECT_LE(deviation, 0.055);
  EXPECT_LE(turn, 0.12);
}

TEST(SetpointFollower, GoesToAFarSetpointStraightInJointSpaceAndStops) {
  SetpointFollower follower(jaco(), params());
  follower.start(home());
  JointVector there(7);
  there << -0.6, 3.4, 0.5, 1.6, 1.0, 2.6, 0.5;
  const PoseSetpoint setpoint{forward(there), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  FollowerStep step;
  std::vector<JointVector> path{home()};
  for (int i = 0; i < 600; ++i) {
    const MotionState before = follower.state();
    step = follower.follow(setpoint, kDt);
    expect_within_limits(before, step.motion.state, kDt);
    const bool arrived = step.position_deviation <= 1e-8;
    if (!arrived) path.push_back(step.motion.state.position);
  }
  EXPECT_EQ(step.goal, GoalKind::kExact);
  EXPECT_LE(step.position_deviation, 1e-8);
  const Twist twist =
      jaco_kinematics::jacobian(step.motion.state.position) * step.motion.state.velocity;
  EXPECT_LE(twist.norm(), 1e-3);
  EXPECT_LE(step.motion.state.velocity.norm(), kPostureSpeed + 1e-6);
  const JointVector way = path.back() - path.front();
  for (const JointVector& q : path) {
    const double share = (q - path.front()).dot(way) / way.squaredNorm();
    EXPECT_LE(share, 1.0 + 1e-9);
    EXPECT_LE((q - path.front() - share * way).norm(), 0.1 * way.norm());
  }
}

TEST(SetpointFollower, PassesTheShoulderSingularityExactly) {
  JointVector q(7);
  q << 0.4, M_PI - 0.5, 0.0, 2.0, 0.3, 2.5, 0.0;
  SetpointFollower follower(jaco(), params());
  follower.start(q);
  JointVector last = q;
  for (int i = 0; i < 600; ++i) {
    q[1] = M_PI - 0.5 + std::min(1.0, 0.2 * kDt * i);
    PoseSetpoint setpoint;
    setpoint.hand_in_base = forward(q);
    const Twist twist = jaco_kinematics::jacobian(q).col(1) * (i < 500 ? 0.2 : 0.0);
    setpoint.linear_velocity = twist.head<3>();
    setpoint.angular_velocity = twist.tail<3>();
    const FollowerStep step = follower.follow(setpoint, kDt);
    ASSERT_LE((step.motion.state.position - last).cwiseAbs().maxCoeff(), 0.01);
    last = step.motion.state.position;
    const bool settled = (i > 30 && i < 500) || i > 560;  // the velocity changes at 0 and 500
    ASSERT_LE(step.position_deviation, settled ? 1e-6 : 3e-3) << i;
  }
}

TEST(SetpointFollower, GoesToTheNearestPoseOfOneOutOfReach) {
  SetpointFollower follower(jaco(), params());
  follower.start(home());
  PoseSetpoint setpoint;
  setpoint.hand_in_base = forward(home());
  setpoint.hand_in_base.translation() = Eigen::Vector3d(0.0, -1.2, 0.2755);
  FollowerStep step;
  for (int i = 0; i < 1500; ++i) step = follower.follow(setpoint, kDt);
  EXPECT_EQ(step.goal, GoalKind::kNearest);
  EXPECT_LE(step.motion.state.velocity.norm(), 1e-3);
  const JointVector nearest =
      nearest_pose(*jaco(), setpoint.hand_in_base, step.motion.state.position, 0.2);
  EXPECT_LE(pose_error(forward(step.motion.state.position), forward(nearest)).norm(), 1e-3);
  EXPECT_GT(step.position_deviation, 0.2);
  EXPECT_LT(step.position_deviation, 0.4);
}

TEST(SetpointFollower, HoldStopsWithinTheAccelerationLimitAndStays) {
  SetpointFollower follower(jaco(), params());
  follower.start(home());
  for (int i = 0; i < 100; ++i) (void)follower.follow(swaying(kDt * i, 0.05, 2.4), kDt);
  for (int i = 0; i < 30; ++i) {
    const MotionState before = follower.state();
    expect_within_limits(before, follower.hold(kDt).motion.state, kDt);
  }
  const MotionState still = follower.state();
  EXPECT_EQ(still.velocity, JointVector::Zero(7));
  EXPECT_EQ(follower.hold(kDt).motion.state.position, still.position);
}

TEST(SetpointFollower, BrakesDownToNewVelocityLimitsWithinTheAccelerationLimit) {
  SetpointFollower follower(jaco(), params());
  follower.start(home());
  PoseSetpoint far;
  far.hand_in_base = forward(JointVector(home().array() + 0.5));
  MotionState before = follower.state();
  for (int tick = 0; tick < 60; ++tick) before = follower.follow(far, kDt).motion.state;
  FollowerParams slow = params();
  slow.velocity_scale = 0.2;
  follower.tune(slow);
  for (int tick = 0; tick < 40; ++tick) {
    const MotionState after = follower.follow(far, kDt).motion.state;
    ASSERT_NO_FATAL_FAILURE(expect_within_limits(before, after, kDt));
    before = after;
  }
  EXPECT_LE((before.velocity.cwiseAbs() - 0.2 * jaco_joint_limits().velocity).maxCoeff(), 1e-11);
  EXPECT_GE(before.velocity.norm(), 0.05);

  slow.acceleration = -1.0;
  EXPECT_THROW(follower.tune(slow), std::invalid_argument);
}

TEST(SetpointFollower, StartsWhereTheJointsAre) {
  SetpointFollower follower(jaco(), params());
  EXPECT_FALSE(follower.started());
  JointVector outside = home();
  outside[1] = jaco_joint_limits().lower[1] - 0.1;
  follower.start(outside);
  EXPECT_EQ(follower.state().position, outside);
  EXPECT_EQ(follower.hold(kDt).motion.state.position, outside);
  EXPECT_THROW(follower.start(JointVector::Constant(7, std::nan(""))), std::invalid_argument);
}

}  // namespace
}  // namespace prf_control
