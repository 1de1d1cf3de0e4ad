// SPDX-License-Identifier: BSD-3-Clause
// The follower with arms of other joints than the Jaco's.
#include <gtest/gtest.h>

#include <cmath>
#include <prf_robots/robot.hpp>

#include "follower_limits.hpp"
#include "prf_control/arm_controller.hpp"

namespace prf_control {
namespace {

class OtherArms : public testing::TestWithParam<const char*> {
 protected:
  prf_robots::Robot robot_ =
      prf_robots::load_robot(std::string(ROBOTS_DIR) + "/" + static_cast<const char*>(GetParam()));
};

TEST_P(OtherArms, MeetAMovingPoseExactlyWithinTheirLimits) {
  constexpr double kAmplitude = 0.05, kRate = 2.0;  // m, rad/s
  const auto& limits = robot_.kinematics->limits();
  SetpointFollower follower(robot_.kinematics, params());
  follower.start(robot_.ready);
  const Eigen::Isometry3d start = robot_.kinematics->forward(robot_.ready);
  for (int tick = 1; tick <= 600; ++tick) {
    const double phase = kRate * kDt * tick;
    PoseSetpoint setpoint{start, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    setpoint.hand_in_base.translation().y() += kAmplitude * (1.0 - std::cos(phase));
    setpoint.linear_velocity.y() = kAmplitude * kRate * std::sin(phase);
    const MotionState before = follower.state();
    const FollowerStep step = follower.follow(setpoint, kDt);
    const MotionState& now = step.motion.state;
    ASSERT_EQ(now.position.size(), limits.lower.size());
    ASSERT_LE((limits.lower - now.position).cwiseMax(now.position - limits.upper).maxCoeff(), 0.0);
    ASSERT_LE((now.velocity.cwiseAbs() - 0.95 * limits.velocity).maxCoeff(), 1e-11);
    ASSERT_LE((now.velocity - before.velocity).cwiseAbs().maxCoeff(), 4.0 * kDt + 1e-10);
    if (tick < 100) continue;
    ASSERT_LE(step.position_deviation, 1e-6) << tick;
    ASSERT_LE(step.orientation_deviation, 1e-6) << tick;
  }
}

TEST_P(OtherArms, GoToTheNearestPoseOfOneOutOfReach) {
  SetpointFollower follower(robot_.kinematics, params());
  follower.start(robot_.ready);
  PoseSetpoint setpoint;
  setpoint.hand_in_base = robot_.kinematics->forward(robot_.ready);
  setpoint.hand_in_base.translation().x() += 2.0;
  FollowerStep step;
  for (int tick = 0; tick < 600; ++tick) step = follower.follow(setpoint, kDt);
  EXPECT_EQ(step.goal, GoalKind::kNearest);
  EXPECT_LE(step.motion.state.velocity.cwiseAbs().maxCoeff(), 0.01);
}

TEST_P(OtherArms, AreRefusedWithOtherNames) {
  EXPECT_THROW(SetpointFollower(nullptr, params()), std::invalid_argument);
  std::vector<std::string> names = robot_.joints;
  EXPECT_NO_THROW(ArmController(robot_.kinematics, {params(), 0.2, 0.3, names}));
  names.pop_back();
  EXPECT_THROW(ArmController(robot_.kinematics, {params(), 0.2, 0.3, names}),
               std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Robots, OtherArms, testing::Values("ur5e_deck", "panda_deck", "gen3_v60"));

}  // namespace
}  // namespace prf_control
