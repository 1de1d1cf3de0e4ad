// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "geometry.hpp"
#include "jaco_kinematics/jaco_kinematics.hpp"
#include "random_joints.hpp"

namespace jaco_kinematics {
namespace {

// The motion for `time` seconds, with the hand kept by inverse().
JointVector drifted(JointVector q, double time) {
  constexpr double kStep = 0.01;
  const Eigen::Isometry3d pose = forward(q);
  for (double t = 0.0; t < time; t += kStep) {
    q = inverse(pose, q + kStep * posture_motion(q)).q;
  }
  return q;
}

double from_preferred(const JointVector& q) {
  return std::abs(wrap_angle(arm_angle(q) - kPreferredArmAngle));
}

TEST(PostureMotion, LeavesTheHandInPlace) {
  std::mt19937 generator(41);
  for (int trial = 0; trial < 1000; ++trial) {
    const JointVector q = random_joints(&generator);
    const JointVector motion = posture_motion(q);
    ASSERT_LT(motion.norm(), 1.0);
    ASSERT_LT((jacobian(q) * motion).norm(), 1e-5) << q.transpose();
  }
}

// From any arm angle of the stand-off pose that the limits allow, but upright. Where they bar the
// way, the elbow waits low on the other side.
TEST(PostureMotion, GoesToThePreferredArmAngleOrLowOnTheOtherSide) {
  int begun = 0;
  int arrived = 0;
  for (double phi = -3.1; phi < 3.1; phi += 0.2) {
    for (const IkSolution& solution : inverse_at_arm_angle(stand_off_pose(), phi)) {
      if (!solution.within_limits) continue;
      ++begun;
      const JointVector q = drifted(solution.q, 20.0);
      ASSERT_TRUE(inside_limits(q));
      if (from_preferred(q) < 0.5) ++arrived;
      EXPECT_TRUE(from_preferred(q) < 0.5 || arm_angle(q) < -1.0) << phi << ": " << arm_angle(q);
    }
  }
  EXPECT_GT(begun, 100);
  EXPECT_GT(arrived, begun / 2);
}

TEST(PostureMotion, GoesToZeroInThePosture) {
  const JointVector start = any_inverse(stand_off_pose()).q;
  const JointVector q = drifted(start, 20.0);
  EXPECT_LT(posture_motion(q).norm(), 1e-3);
  EXPECT_LT((drifted(q, 5.0) - q).norm(), 1e-3);
}

// Low over the box the preferred arm angle would bring joint 6 to its limit.
TEST(PostureMotion, KeepsClearOfALimit) {
  const JointVector start =
      (JointVector() << 1.07, 2.02, 0.64, 1.24, -0.99, 1.83, -1.01).finished();
  const double lower = jaco_joint_limits().lower[5];
  double there = 10.0;
  for (const auto& solution : inverse_at_arm_angle(forward(start), kPreferredArmAngle)) {
    if (solution.branch == 0) there = solution.q[5] - lower;
  }
  ASSERT_LT(there, 0.25);
  EXPECT_GT(drifted(start, 20.0)[5] - lower, 0.32);
}

}  // namespace
}  // namespace jaco_kinematics
