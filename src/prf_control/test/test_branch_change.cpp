// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "follower_limits.hpp"
#include "prf_control/setpoint_follower.hpp"

namespace prf_control {
namespace {

using jaco_kinematics::forward;
using jaco_kinematics::jaco_joint_limits;

// Fault 25: inverse kinematics jump to another branch -> refused, the goal creeps along the
// Jacobian
TEST(BranchChange, IsRefusedAtFirstAndTheGoalCreepsInstead) {
  FollowerParams strict = params();
  strict.max_joint_step = 0.02;
  SetpointFollower follower(jaco(), strict);
  follower.start(home());
  PoseSetpoint setpoint;
  setpoint.hand_in_base = forward(home());
  setpoint.hand_in_base.translation().y() += 0.08;  // near, but more than 0.02 rad away
  FollowerStep step = follower.follow(setpoint, kDt);
  EXPECT_EQ(step.goal, GoalKind::kJumpRefused);
  EXPECT_GT(step.jump, 0.02);
  ASSERT_GE(step.jump_joint, 0);
  for (int i = 0; i < 300; ++i) step = follower.follow(setpoint, kDt);
  EXPECT_EQ(step.goal, GoalKind::kExact);
  EXPECT_LE(step.position_deviation, 1e-6);
}

// Poses just beyond a joint limit of the arm as it stands, which another branch gives.
std::vector<std::pair<JointVector, Eigen::Isometry3d>> poses_of_other_branches() {
  const auto& joints = jaco_joint_limits();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::vector<std::pair<JointVector, Eigen::Isometry3d>> found;
  for (int trial = 0; trial < 4000 && found.size() < 4; ++trial) {
    JointVector q = JointVector::NullaryExpr(7, [&] { return angle(random); });
    for (int i : {1, 3, 5}) q[i] = M_PI + 0.4 * q[i];
    q[5] = joints.upper[5];
    const JointVector beyond = q + 0.08 * JointVector::Unit(7, 5);
    const auto solution = jaco_kinematics::inverse(forward(beyond), q);
    const bool solved = solution.status == jaco_kinematics::IkStatus::kSolved;
    if (solved && (solution.q - q).cwiseAbs().maxCoeff() > 1.0) {
      found.push_back({q, forward(beyond)});
    }
  }
  return found;
}

// Fault 25: a change of branch -> refused for a second (the per-joint step limit), then made at a
// quarter of the speed
TEST(BranchChange, IsMadeSlowlyWhenItStaysRefused) {
  // Ticks to brake from the velocity limit to a quarter of it at 4 rad/s^2.
  const int kSlowing = static_cast<int>(0.75 * 0.95 * 0.838 / 4.0 / kDt) + 1;
  int changed = 0;
  const auto cases = poses_of_other_branches();
  ASSERT_EQ(cases.size(), 4u);
  for (const auto& [start, pose] : cases) {
    SetpointFollower follower(jaco(), params());
    follower.start(start);
    MotionState before = follower.state();
    FollowerStep step;
    double refused = 0;
    bool changes = false;
    double excess = 0;  // of the quarter of the velocity limits that a change may use
    int slowing = 0;    // ticks since the change began with the speed of the creep
    int over = 0;       // ticks since the change
    for (int tick = 0; tick < 3000 && over < 50; ++tick) {
      PoseSetpoint setpoint;  // it moves all the time
      setpoint.hand_in_base = pose;
      setpoint.hand_in_base.translation().x() += 1e-3 * std::sin(0.05 * tick);
      step = follower.follow(setpoint, kDt);
      ASSERT_NO_FATAL_FAILURE(expect_within_limits(before, step.motion.state, kDt));
      before = step.motion.state;
      over = changes && step.goal != GoalKind::kChangesBranch ? over + 1 : 0;
      if (step.goal == GoalKind::kJumpRefused) refused += kDt;
      if (step.goal == GoalKind::kChangesBranch) {
        changes = true;
        const JointVector allowed = 0.95 * kSlowly * jaco_joint_limits().velocity;
        const double last = excess;
        excess = (before.velocity.cwiseAbs() - allowed).maxCoeff();
        ASSERT_LE(excess, slowing > 0 ? std::max(last, 1e-9) : 1.0) << "only ever slower";
        ASSERT_LE(excess, slowing < kSlowing ? 1.0 : 1e-9) << slowing;
        ++slowing;
      } else {
        slowing = 0;
      }
    }
    if (!changes) continue;  // the creep got there
    ++changed;
    EXPECT_GE(refused, 0.9);
    EXPECT_TRUE(step.goal == GoalKind::kExact || step.goal == GoalKind::kNearest);
    EXPECT_LE(step.position_deviation, 2e-3);
  }
  EXPECT_GE(changed, 2);
}

}  // namespace
}  // namespace prf_control
