// SPDX-License-Identifier: BSD-3-Clause
#include "pose_step.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>

#include "random_joints.hpp"

namespace jaco_kinematics {
namespace {

TEST(PoseStep, IsTheShortestAndTheSelfMotionLeavesTheHand) {
  std::mt19937 generator(21);
  std::normal_distribution<> normal(0.0, 0.01);
  int singular = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Frames frames = link_frames(random_joints(&generator));
    const Jacobian j = jacobian(frames);
    using Difference = Eigen::Matrix<double, 6, 1>;
    const Difference difference = Difference::NullaryExpr([&] { return normal(generator); });
    const PoseStep step = pose_step(frames, difference);
    ASSERT_NEAR(step.self_motion.norm(), 1.0, 1e-12);
    ASSERT_LT((j * step.self_motion).norm(), 1e-4) << "trial " << trial;
    ASSERT_LT((j * step.least - difference).norm(), 1e-4 * (1.0 + step.least.norm()));
    // At a singularity more than one motion leaves the hand.
    if (j.jacobiSvd().singularValues()[5] < 0.01) {
      ++singular;
      continue;
    }
    ASSERT_LT(std::abs(step.self_motion.dot(step.least)), 1e-6 * (1.0 + step.least.norm()));
  }
  EXPECT_LT(singular, 150);
}

}  // namespace
}  // namespace jaco_kinematics
