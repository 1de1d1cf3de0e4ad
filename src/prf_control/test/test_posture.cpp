// SPDX-License-Identifier: BSD-3-Clause
// The arm's posture while it follows for long: it depends on where the hand is, not on the way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "follower_limits.hpp"
#include "prf_control/nearest_pose.hpp"

namespace prf_control {
namespace {

using jaco_kinematics::forward;

// The arm in front of the box, with the joints of a heavy stepping trial.
JointVector in_front() {
  return (JointVector(7) << 0.75, 1.80, 0.50, 1.35, -0.75, 1.60, -0.70).finished();
}

// The target's sway as the arm's base sees it on the heavy platform, 0.15 m/s and 0.1 rad/s rms.
// Its closed loops turn the arm angle a little each, always the same way: without the drift the
// elbow is upright and the hand 31 mm rms behind after 100 s.
PoseSetpoint on_the_platform(double time) {
  const auto sway = [&](double amplitude, double frequency, double phase) {
    return std::pair{amplitude * std::sin(frequency * time + phase),
                     amplitude * frequency * std::cos(frequency * time + phase)};
  };
  const auto x = sway(0.09, 1.7, 4.16);
  const auto y = sway(0.10, 1.7, 5.47);
  const auto z = sway(0.05, 1.7, 5.10);
  const auto pitch = sway(0.08, 1.7, 2.35);
  PoseSetpoint setpoint;
  setpoint.hand_in_base = forward(in_front());
  setpoint.hand_in_base.translation() += Eigen::Vector3d(x.first, y.first, z.first);
  setpoint.hand_in_base.linear() =
      Eigen::AngleAxisd(pitch.first, Eigen::Vector3d::UnitY()).toRotationMatrix() *
      setpoint.hand_in_base.linear();
  setpoint.linear_velocity = {x.second, y.second, z.second};
  setpoint.angular_velocity = {0.0, pitch.second, 0.0};
  return setpoint;
}

struct Deviation {
  double rms = 0.0;   // m
  double most = 0.0;  // m
};

// Over `seconds` from `begin` on.
Deviation follow(SetpointFollower* follower, double begin, double seconds) {
  Deviation deviation;
  const int ticks = static_cast<int>(seconds / kDt);
  for (int i = 0; i < ticks; ++i) {
    const MotionState before = follower->state();
    const FollowerStep step = follower->follow(on_the_platform(begin + i * kDt), kDt);
    expect_within_limits(before, step.motion.state, kDt);
    deviation.rms += step.position_deviation * step.position_deviation / ticks;
    deviation.most = std::max(deviation.most, step.position_deviation);
  }
  deviation.rms = std::sqrt(deviation.rms);
  return deviation;
}

// Two minutes: "64 to 77 mm rms behind after most of a minute" it was.
TEST(Posture, StaysWhileTheHandFollowsThePlatformForLong) {
  SetpointFollower follower(jaco(), params());
  follower.start(in_front());
  (void)follow(&follower, 0.0, 10.0);
  const Deviation first = follow(&follower, 10.0, 20.0);
  (void)follow(&follower, 30.0, 70.0);
  const Deviation last = follow(&follower, 100.0, 20.0);
  EXPECT_LE(last.rms, 1.1 * first.rms + 1e-3);
  EXPECT_LE(last.most, 0.005);
  RecordProperty("first_um", static_cast<int>(1e6 * first.rms));
  RecordProperty("last_um", static_cast<int>(1e6 * last.rms));
}

// From the elbow high on either side, where joints 1 and 3 turn fast for little motion of the hand.
TEST(Posture, ComesBackWhileTheHandFollows) {
  for (const double high : {-1.0, 0.6}) {
    JointVector begin = in_front();
    for (const auto& solution : jaco_kinematics::inverse_at_arm_angle(forward(in_front()), high)) {
      if (solution.within_limits) begin = solution.q;
    }
    ASSERT_NEAR(jaco_kinematics::arm_angle(begin), high, 1e-6);
    SetpointFollower follower(jaco(), params());
    follower.start(begin);
    (void)follow(&follower, 0.0, 30.0);
    const double phi = jaco_kinematics::arm_angle(follower.state().position);
    EXPECT_NEAR(phi, jaco_kinematics::kPreferredArmAngle, 0.8) << "from " << high;
    EXPECT_LE(follow(&follower, 30.0, 20.0).most, 0.03) << "from " << high;
  }
}

TEST(Posture, DriftsWithoutMovingTheHand) {
  SetpointFollower follower(jaco(), params());
  follower.start(home());
  PoseSetpoint setpoint;
  setpoint.hand_in_base = forward(home());
  for (int tick = 0; tick < 4000; ++tick) {
    const MotionState before = follower.state();
    const FollowerStep step = follower.follow(setpoint, kDt);
    ASSERT_NO_FATAL_FAILURE(expect_within_limits(before, step.motion.state, kDt));
    ASSERT_EQ(step.goal, GoalKind::kExact);
    ASSERT_LT(step.position_deviation, 1e-9) << "tick " << tick;
    ASSERT_LT(step.orientation_deviation, 1e-9) << "tick " << tick;
    ASSERT_LE(step.motion.state.velocity.norm(), kPostureSpeed + 1e-3);
  }
  EXPECT_LT(follower.state().velocity.norm(), 1e-2);
}

}  // namespace
}  // namespace prf_control
