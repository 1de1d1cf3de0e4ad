// SPDX-License-Identifier: BSD-3-Clause
// inverse() with each result as the seed of the next pose, as a controller calls it.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "expect_meets.hpp"
#include "jaco_kinematics/jaco_kinematics.hpp"
#include "random_joints.hpp"

namespace jaco_kinematics {
namespace {

// The shortest joint motion that changes the pose alike, to first order.
double least_motion(const JointVector& q, const Eigen::Isometry3d& to) {
  const Eigen::Isometry3d from = forward(q);
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  Eigen::Matrix<double, 6, 1> change;
  change << to.translation() - from.translation(), turn.angle() * turn.axis();
  return jacobian(q).completeOrthogonalDecomposition().solve(change).norm();
}

struct Walk {
  JointVector q;
  int far = 0;  // steps that took more than kSlack, beside the least motion
};

constexpr double kSlack = 0.001;     // [rad]
constexpr double kFarthest = 0.009;  // [rad]

// Moves to the next pose of a path, with the last result as seed. Beside the least motion there is
// room for its second order next to singularities and for the pull away from limits; the largest
// found is 1.18 times the least.
void follow(const Eigen::Isometry3d& pose, Walk* walk) {
  const IkResult result = inverse(pose, walk->q);
  ASSERT_NO_FATAL_FAILURE(expect_meets(pose, result));
  const double more = (result.q - walk->q).norm() - 1.2 * least_motion(walk->q, pose);
  ASSERT_LE(more, kFarthest);
  if (more > kSlack) ++walk->far;
  walk->q = result.q;
}

// Smooth random joint paths.
TEST(JacoInverse, IsContinuousAlongSmoothPaths) {
  constexpr int kSteps = 1000;
  const JointLimits& limits = jaco_joint_limits();
  std::mt19937 generator(13);
  std::uniform_real_distribution<> phase(0.0, 2.0 * M_PI);
  for (int path = 0; path < 20; ++path) {
    JointVector centre = random_joints(&generator);
    JointVector start;
    for (int i = 0; i < 7; ++i) {
      start[i] = phase(generator);
      if (std::isinf(limits.upper[i])) continue;
      // Well inside limits, the elbow bent: what follows is no question of reach.
      const double side = centre[i] - M_PI;
      centre[i] = M_PI + std::copysign(i == 3 ? 1.6 : std::min(0.9, std::abs(side)), side);
    }
    const auto joints_at = [&](int step) {
      const double t = 2.0 * M_PI * step / kSteps;
      return JointVector(centre.array() + 0.5 * (start.array() + t).sin());
    };
    Walk walk{joints_at(0)};
    for (int step = 1; step <= kSteps; ++step) {
      ASSERT_NO_FATAL_FAILURE(follow(forward(joints_at(step)), &walk))
          << "path " << path << " step " << step;
    }
    EXPECT_EQ(walk.far, 0) << "path " << path;
  }
}

// The given path moves no joint by more than 0.0045 rad a step.
TEST(JacoInverse, PassesTheShouldersSingularityWithoutAJump) {
  constexpr int kSteps = 400;
  constexpr double kTwoSteps = 0.009;  // [rad]
  constexpr double kLargest = 0.018;   // [rad]
  // [rad] On one path shoulder and wrist are nearly singular at once, for one step: the arm angle
  // is all but free there, and the posture's pull turns it. A change of branch turns a joint by
  // much more.
  constexpr double kTwiceSingular = 0.038;
  int passed = 0;
  int twice_singular = 0;
  int far = 0;
  int within_two_steps = 0;
  std::mt19937 generator(14);
  for (int path = 0; path < 50; ++path) {
    JointVector centre = random_joints(&generator);
    centre[1] = M_PI;
    centre[3] = M_PI + 1.6;
    centre[5] = M_PI + 0.9;
    const auto joints_at = [&](int step) {
      JointVector q = centre;
      q[1] += 0.8 * (2.0 * step / kSteps - 1.0);
      q[3] += 0.3 * std::sin(6.0 * step / kSteps);
      return q;
    };
    Walk walk{joints_at(0)};
    double largest = 0.0;
    for (int step = 1; step <= kSteps; ++step) {
      const JointVector before = walk.q;
      ASSERT_NO_FATAL_FAILURE(follow(forward(joints_at(step)), &walk))
          << "path " << path << " step " << step;
      largest = std::max(largest, (walk.q - before).cwiseAbs().maxCoeff());
    }
    EXPECT_LE(largest, kTwiceSingular) << "path " << path;
    if (largest <= kTwoSteps) ++within_two_steps;
    if (largest > kLargest) ++twice_singular;
    far += walk.far;
    if (walk.q[1] > M_PI + 0.1) ++passed;
  }
  EXPECT_LE(twice_singular, 1);
  EXPECT_LE(far, 1);
  EXPECT_GE(within_two_steps, 39);
  EXPECT_GE(passed, 45);
}

}  // namespace
}  // namespace jaco_kinematics
