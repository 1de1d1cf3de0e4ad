// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/measured_joints.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <limits>
#include <random>

namespace prf_control {
namespace {

const std::vector<std::string> kNames = {"j1", "j2", "j3", "j4", "j5", "j6", "j7"};

const JointLimits& limits() {
  static const JointLimits jaco = [] {
    const auto& joints = jaco_kinematics::jaco_joint_limits();
    return JointLimits{joints.lower, joints.upper, joints.velocity, joints.effort, {}};
  }();
  return jaco;
}

JointVector home() { return (JointVector(7) << 0.3, 3.9, 0.2, 1.9, 0.4, 2.4, -0.3).finished(); }

// Fault 1, 43: a joint position that is not finite or 1e300 -> the tick's joints are not used,
// joint and value are named
TEST(MeasuredJoints, RefusesWhatIsNoAngle) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, -1001.0}) {
    JointVector q = home();
    q[4] = bad;
    const JointSample sample = checked_joints(prf_core::Stamp{5}, q, kNames);
    EXPECT_FALSE(sample.position);
    EXPECT_NE(sample.fault.find("j5"), std::string::npos) << sample.fault;
    EXPECT_EQ(sample.stamp, prf_core::Stamp{5});
  }
  EXPECT_EQ(*checked_joints(prf_core::Stamp{5}, home(), kNames).position, home());
}

// Fault 37: a joint reported in another turn -> taken in the turn of its limits; the continuous
// ones count
TEST(MeasuredJoints, AreTakenInTheTurnOfTheLimits) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::uniform_int_distribution<int> turns(-50, 50);
  for (int trial = 0; trial < 2000; ++trial) {
    JointVector q = JointVector::NullaryExpr(7, [&] { return angle(random); });
    for (const int i : {1, 3, 5}) {
      q[i] = limits().lower[i] + share(random) * (limits().upper[i] - limits().lower[i]);
    }
    EXPECT_EQ(unwrapped(q, limits()), q) << "the right turn already: not a bit is changed";
    JointVector turned = q;
    for (int i = 0; i < 7; ++i) turned[i] += 2.0 * M_PI * turns(random);
    const JointVector taken = unwrapped(turned, limits());
    for (const int i : {1, 3, 5}) ASSERT_NEAR(taken[i], q[i], 1e-12);
    for (const int i : {0, 2, 4, 6}) ASSERT_EQ(taken[i], turned[i]);
    const JointVector moved = q + turns_between(q, taken, limits());
    ASSERT_LE((moved - taken).cwiseAbs().maxCoeff(), 1e-12);
  }
}

// Fault 37: joint 4 reported as -1.0 rad -> it is 5.283 rad, within its limits
TEST(MeasuredJoints, FindsTheTurnWithinTheLimits) {
  JointVector q = home();
  q[3] = -1.0;
  EXPECT_NEAR(unwrapped(q, limits())[3], 5.2831853, 1e-7);
}

TEST(MeasuredJoints, OutsideTheLimitsAreTakenNearThem) {
  JointVector q = home();
  q[1] = limits().lower[1] - 0.1 + 2.0 * M_PI;
  EXPECT_NEAR(unwrapped(q, limits())[1], limits().lower[1] - 0.1, 1e-12);
  EXPECT_NEAR(joints_outside(unwrapped(q, limits()), limits()).maxCoeff(), 0.1, 1e-12);
  EXPECT_EQ(joints_outside(home(), limits()).maxCoeff(), 0.0);
}

}  // namespace
}  // namespace prf_control
