// SPDX-License-Identifier: BSD-3-Clause
// The follower keeps every limit for random set-points; impossible parameters are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "controller_test.hpp"
#include "prf_control/arm_controller.hpp"
#include "prf_control/setpoint_follower.hpp"

namespace prf_control {
namespace {

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

// Fault 25, 43: any set-point, a kilometre away or at 900 rad/s -> every command within all limits
TEST(SetpointFollower, KeepsEveryLimitWhateverIsAsked) {
  std::mt19937 random(11);
  SetpointFollower follower(jaco(), params());
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
// the folded wrist. The commands never jump, whichever branches the solutions change; a refused
// change of branch lasts no longer than branch_patience.
// Fault 25: the hand is led through singular postures -> no joint jumps, refusals end after
// branch_patience
TEST(SetpointFollower, PassesSingularPosturesWithoutAJump) {
  constexpr int kTicks = 400;
  const int patience = static_cast<int>(params().branch_patience / kDt);
  std::mt19937 random(12);
  int lines = 0;
  int refused = 0;
  int exact = 0;
  for (int line = 0; line < 60; ++line) {
    PoseSetpoint setpoint;
    setpoint.hand_in_base = random_pose(random, 0.45);
    setpoint.linear_velocity = random_vector(random, 0.15);
    const auto first = jaco_kinematics::inverse(setpoint.hand_in_base, home());
    if (first.status != jaco_kinematics::IkStatus::kSolved) continue;
    ++lines;
    SetpointFollower follower(jaco(), params());
    follower.start(first.q);
    int in_a_row = 0;
    for (int i = 0; i < kTicks; ++i) {
      const MotionState before = follower.state();
      const FollowerStep step = follower.follow(setpoint, kDt);
      ASSERT_NO_FATAL_FAILURE(expect_within_limits(before, step.motion.state, kDt)) << line;
      in_a_row = step.goal == GoalKind::kJumpRefused ? in_a_row + 1 : 0;
      ASSERT_LE(in_a_row, patience) << "line " << line << " tick " << i;
      refused += step.goal == GoalKind::kJumpRefused;
      exact += step.goal == GoalKind::kExact;
      setpoint = moved(setpoint, kDt);
    }
  }
  EXPECT_GE(lines, 30);
  EXPECT_GE(exact, 11400) << "of " << lines * kTicks;
  EXPECT_LE(refused, 1700) << "of " << lines * kTicks;
  EXPECT_GT(refused, 0) << "no line meets a change of branch";
}

// Fault 28, 52: a parameter beyond its physical bounds on either side -> refused by name
TEST(FollowerParams, RefuseImpossibleValuesByName) {
  const double nan = std::nan("");
  const auto refusal = [](double FollowerParams::*member, double value) -> std::string {
    FollowerParams bad = params();
    bad.*member = value;
    try {
      SetpointFollower follower(jaco(), bad);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  for (const double value : {0.0, -1.0, nan, 1e9, 5e-324, 1e308}) {
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

// Fault 28, 52: a bound of the controller itself beyond physics -> refused by name
TEST(ArmControllerParams, RefuseImpossibleValuesByName) {
  const auto refusal = [](const ArmControllerParams& bad) -> std::string {
    try {
      ArmController controller(jaco(), bad);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const ArmControllerParams good = controller_params();
  EXPECT_EQ(refusal(good), "");
  ArmControllerParams bad = good;
  bad.max_tracking_error = std::nan("");
  EXPECT_NE(refusal(bad).find("max_tracking_error"), std::string::npos);
  for (const double wait : {0.0, -1.0, std::nan(""), 11.0}) {
    bad = good;
    bad.max_wait = wait;
    EXPECT_NE(refusal(bad).find("max_wait"), std::string::npos) << wait;
  }
}

}  // namespace
}  // namespace prf_control
