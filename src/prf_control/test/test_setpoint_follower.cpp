// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/setpoint_follower.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "follower_limits.hpp"
#include "prf_control/nearest_pose.hpp"

namespace prf_control {
namespace {

using jaco_kinematics::forward;
using jaco_kinematics::jaco_joint_limits;

using Twist = Eigen::Matrix<double, 6, 1>;

Eigen::Isometry3d random_pose(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> place(-size, size);
  std::normal_distribution<double> normal;
  const Eigen::Vector4d q = Eigen::Vector4d::NullaryExpr([&] { return normal(random); });
  Eigen::Isometry3d pose(Eigen::Quaterniond(Eigen::Vector4d(q.normalized())));
  pose.translation() = Eigen::Vector3d(place(random), place(random), 0.3 + place(random));
  return pose;
}

Eigen::Vector3d random_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return {uniform(random), uniform(random), uniform(random)};
}

PoseSetpoint moved(const PoseSetpoint& from, double dt) {
  PoseSetpoint to = from;
  const Eigen::Vector3d turn = from.angular_velocity * dt;
  to.hand_in_base.translation() += from.linear_velocity * dt;
  if (turn.norm() > 0.0) {
    to.hand_in_base.linear() =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()) * from.hand_in_base.linear();
  }
  return to;
}

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
  SetpointFollower follower(params());
  follower.start(home());
  for (int i = 0; i < 1000; ++i) {
    const PoseSetpoint setpoint = swaying(kDt * i, 0.05, 2.4);
    const FollowerStep step = follower.follow(setpoint, kDt);
    if (i < 150) continue;  // the first velocity needs a run-up, and what it costs is made good
    ASSERT_EQ(step.goal, GoalKind::kExact);
    ASSERT_LE(step.position_deviation, 1e-6) << i;
    ASSERT_LE(step.orientation_deviation, 1e-6) << i;
    const auto error = pose_error(forward(step.motion.state.position), setpoint.hand_in_base);
    ASSERT_LE(error.norm(), 2e-6);
  }
}

TEST(SetpointFollower, CommandsTheVelocityOfTheSetpoint) {
  SetpointFollower follower(params());
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
  SetpointFollower follower(params());
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
  SetpointFollower follower(params());
  follower.start(home());
  JointVector there;
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
  EXPECT_LE(step.motion.state.velocity.norm(), kNullSpaceSpeed + 1e-6);
  const JointVector way = path.back() - path.front();
  for (const JointVector& q : path) {
    const double share = (q - path.front()).dot(way) / way.squaredNorm();
    EXPECT_LE(share, 1.0 + 1e-9);
    EXPECT_LE((q - path.front() - share * way).norm(), 0.1 * way.norm());
  }
}

TEST(SetpointFollower, KeepsEveryLimitWhateverIsAsked) {
  std::mt19937 random(11);
  SetpointFollower follower(params());
  follower.start(home());
  std::uniform_int_distribution<int> kind(0, 9);
  std::uniform_int_distribution<int> duration(1, 120);
  int exact = 0;
  int nearest = 0;
  for (int task = 0; task < 300; ++task) {
    const int what = kind(random);
    PoseSetpoint setpoint;
    setpoint.hand_in_base = random_pose(random, what == 9 ? 900.0 : what == 8 ? 2.0 : 0.7);
    const double fast = what == 7 ? 900.0 : 0.2;
    setpoint.linear_velocity = random_vector(random, fast);
    setpoint.angular_velocity = random_vector(random, fast);
    for (int i = duration(random); i > 0; --i) {
      const double dt = what == 6 ? 0.04 : kDt;
      const MotionState before = follower.state();
      const FollowerStep step = what == 0 ? follower.hold(dt) : follower.follow(setpoint, dt);
      expect_within_limits(before, step.motion.state, dt);
      if (HasFatalFailure()) return;
      ASSERT_TRUE(std::isfinite(step.position_deviation));
      exact += step.goal == GoalKind::kExact;
      nearest += step.goal == GoalKind::kNearest;
      setpoint = moved(setpoint, dt);
    }
  }
  EXPECT_GT(exact, 1000);
  EXPECT_GT(nearest, 1000);
}

// Straight lines of the hand through the whole workspace: over the shoulder, the stretched elbow,
// the folded wrist. The commands must never jump, whichever branches the solutions change.
TEST(SetpointFollower, PassesSingularPosturesWithoutAJump) {
  std::mt19937 random(12);
  int refused = 0;
  int exact = 0;
  for (int line = 0; line < 60; ++line) {
    PoseSetpoint setpoint;
    setpoint.hand_in_base = random_pose(random, 0.45);
    setpoint.linear_velocity = random_vector(random, 0.15);
    const auto first = jaco_kinematics::inverse(setpoint.hand_in_base, home());
    if (first.status != jaco_kinematics::IkStatus::kSolved) continue;
    SetpointFollower follower(params());
    follower.start(first.q);
    for (int i = 0; i < 400; ++i) {
      const MotionState before = follower.state();
      const FollowerStep step = follower.follow(setpoint, kDt);
      expect_within_limits(before, step.motion.state, kDt);
      if (HasFatalFailure()) return;
      refused += step.goal == GoalKind::kJumpRefused;
      exact += step.goal == GoalKind::kExact;
      setpoint = moved(setpoint, kDt);
    }
  }
  EXPECT_GT(exact, 5000);
  RecordProperty("ticks_with_refused_jump", refused);
  RecordProperty("ticks_exact", exact);
}

TEST(SetpointFollower, PassesTheShoulderSingularityExactly) {
  JointVector q;
  q << 0.4, M_PI - 0.5, 0.0, 2.0, 0.3, 2.5, 0.0;
  SetpointFollower follower(params());
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

TEST(SetpointFollower, DriftsToABetterPostureWhileTheHandStands) {
  for (const int joint : {1, 5}) {
    JointVector q = home();
    q[joint] = M_PI + 0.2;
    SetpointFollower follower(params());
    follower.start(q);
    PoseSetpoint setpoint;
    setpoint.hand_in_base = forward(q);
    for (int tick = 0; tick < 6000; ++tick) {
      const MotionState before = follower.state();
      const FollowerStep step = follower.follow(setpoint, kDt);
      ASSERT_NO_FATAL_FAILURE(expect_within_limits(before, step.motion.state, kDt));
      ASSERT_EQ(step.goal, GoalKind::kExact);
      ASSERT_LT(step.position_deviation, 1e-9) << "tick " << tick;
      ASSERT_LT(step.orientation_deviation, 1e-9) << "tick " << tick;
      ASSERT_LE(step.motion.state.velocity.norm(), kNullSpaceSpeed + 1e-6);
    }
    EXPECT_GT(follower.state().position[joint], M_PI + 0.27) << "joint " << joint + 1;
  }
}

TEST(SetpointFollower, GoesToTheNearestPoseOfOneOutOfReach) {
  SetpointFollower follower(params());
  follower.start(home());
  PoseSetpoint setpoint;
  setpoint.hand_in_base = forward(home());
  setpoint.hand_in_base.translation() = Eigen::Vector3d(0.0, -1.2, 0.2755);
  FollowerStep step;
  for (int i = 0; i < 1500; ++i) step = follower.follow(setpoint, kDt);
  EXPECT_EQ(step.goal, GoalKind::kNearest);
  EXPECT_LE(step.motion.state.velocity.norm(), 1e-3);
  const JointVector nearest = nearest_pose(setpoint.hand_in_base, step.motion.state.position, 0.2);
  EXPECT_LE(pose_error(forward(step.motion.state.position), forward(nearest)).norm(), 1e-3);
  EXPECT_GT(step.position_deviation, 0.2);
  EXPECT_LT(step.position_deviation, 0.4);
}

TEST(SetpointFollower, HoldStopsWithinTheAccelerationLimitAndStays) {
  SetpointFollower follower(params());
  follower.start(home());
  for (int i = 0; i < 100; ++i) (void)follower.follow(swaying(kDt * i, 0.05, 2.4), kDt);
  for (int i = 0; i < 30; ++i) {
    const MotionState before = follower.state();
    expect_within_limits(before, follower.hold(kDt).motion.state, kDt);
  }
  const MotionState still = follower.state();
  EXPECT_EQ(still.velocity, JointVector::Zero());
  EXPECT_EQ(follower.hold(kDt).motion.state.position, still.position);
}

TEST(SetpointFollower, BrakesDownToNewVelocityLimitsWithinTheAccelerationLimit) {
  SetpointFollower follower(params());
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

TEST(SetpointFollower, StartsInsideTheLimits) {
  SetpointFollower follower(params());
  EXPECT_FALSE(follower.started());
  JointVector outside = home();
  outside[1] = 0.1;
  follower.start(outside);
  EXPECT_EQ(follower.state().position[1], jaco_joint_limits().lower[1]);
  EXPECT_THROW(follower.start(JointVector::Constant(std::nan(""))), std::invalid_argument);
}

TEST(FollowerParams, RefuseImpossibleValuesByName) {
  const double nan = std::nan("");
  const auto refusal = [](double FollowerParams::*member, double value) -> std::string {
    FollowerParams bad = params();
    bad.*member = value;
    try {
      SetpointFollower follower(bad);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  for (const double value : {0.0, -1.0, nan, 1e9}) {
    EXPECT_NE(refusal(&FollowerParams::velocity_scale, value).find("velocity_scale"),
              std::string::npos);
    EXPECT_NE(refusal(&FollowerParams::acceleration, value).find("acceleration"),
              std::string::npos);
    EXPECT_NE(refusal(&FollowerParams::max_joint_step, value).find("max_joint_step"),
              std::string::npos);
    EXPECT_NE(refusal(&FollowerParams::far_position, value).find("far_position"),
              std::string::npos);
    EXPECT_NE(refusal(&FollowerParams::far_orientation, value).find("far_orientation"),
              std::string::npos);
    EXPECT_NE(refusal(&FollowerParams::damping, value).find("damping"), std::string::npos);
    EXPECT_NE(refusal(&FollowerParams::branch_patience, value).find("branch_patience"),
              std::string::npos);
    EXPECT_NE(refusal(&FollowerParams::orientation_weight, value).find("orientation_weight"),
              std::string::npos);
  }
  EXPECT_NE(refusal(&FollowerParams::velocity_scale, 1.01).find("velocity_scale"),
            std::string::npos);
}

}  // namespace
}  // namespace prf_control
