// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "expect_meets.hpp"
#include "jaco_kinematics/jaco_kinematics.hpp"
#include "random_joints.hpp"

namespace jaco_kinematics {
namespace {

double wrapped_distance(const JointVector& a, const JointVector& b) {
  double largest = 0.0;
  for (int i = 0; i < 7; ++i) {
    largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2.0 * M_PI)));
  }
  return largest;
}

TEST(JacoInverse, SolvesEveryReachablePoseFromAFarSeed) {
  std::mt19937 generator(11);
  for (int trial = 0; trial < 10000; ++trial) {
    const Eigen::Isometry3d pose = forward(random_joints(&generator));
    ASSERT_NO_FATAL_FAILURE(expect_meets(pose, inverse(pose, ready_joints()))) << trial;
  }
}

TEST(JacoInverse, FindsAnySolutionOfEveryReachablePose) {
  std::mt19937 generator(18);
  for (int trial = 0; trial < 10000; ++trial) {
    const Eigen::Isometry3d pose = forward(random_joints(&generator));
    const IkResult result = any_inverse(pose);
    ASSERT_NO_FATAL_FAILURE(expect_meets(pose, result));
  }
  Eigen::Isometry3d beyond = stand_off_pose();
  beyond.translation().x() = 1.2;
  EXPECT_EQ(any_inverse(beyond).status, IkStatus::kOutOfReach);
  beyond.translation() << 0.15 + 0.26375, 0.0, 0.2755;
  EXPECT_EQ(any_inverse(beyond).status, IkStatus::kNoSolutionWithinLimits);
}

TEST(JacoInverse, StaysAtTheSeedThatAlreadySolves) {
  std::mt19937 generator(12);
  IkParams params;
  params.limit_weight = 0.0;
  for (int trial = 0; trial < 1000; ++trial) {
    const JointVector q = random_joints(&generator);
    const IkResult result = inverse(forward(q), q, params);
    ASSERT_EQ(result.status, IkStatus::kSolved);
    ASSERT_LT((result.q - q).norm(), 1e-6) << q.transpose();
  }
}

// The configuration that the pose was made from is a solution, so the result must not be farther.
TEST(JacoInverse, PrefersTheSolutionNearestToTheSeed) {
  constexpr int kPoses = 2000;
  IkParams params;
  params.limit_weight = 0.0;
  std::mt19937 generator(17);
  std::uniform_real_distribution<> offset(-0.7, 0.7);
  int nearest = 0;
  for (int trial = 0; trial < kPoses; ++trial) {
    const JointVector q = random_joints(&generator);
    JointVector seed = q;
    for (int i = 0; i < 7; ++i) seed[i] += offset(generator);
    const IkResult result = inverse(forward(q), seed, params);
    ASSERT_EQ(result.status, IkStatus::kSolved);
    const double cost = (result.q - seed).cwiseAbs2().dot(params.weight);
    if (cost < (q - seed).cwiseAbs2().dot(params.weight) + 1e-6) ++nearest;
  }
  RecordProperty("nearest", nearest);
  EXPECT_GE(nearest, kPoses * 99 / 100);
}

TEST(JacoInverse, StaysInTheSeedsTurn) {
  JointVector seed = ready_joints();
  for (int i : {0, 2, 4, 6}) seed[i] += 6.0 * M_PI;
  const Eigen::Isometry3d pose = stand_off_pose();
  const IkResult near = inverse(pose, seed);
  ASSERT_NO_FATAL_FAILURE(expect_meets(pose, near));
  EXPECT_LT((near.q - seed).cwiseAbs().maxCoeff(), 0.35);

  const IkResult far = inverse(forward(JointVector(ready_joints().array() + 1.0)), seed);
  ASSERT_EQ(far.status, IkStatus::kSolved);
  for (int i : {0, 2, 4, 6}) EXPECT_LE(std::abs(far.q[i] - seed[i]), M_PI + 1e-6);
}

TEST(JacoInverse, GivesTheSameResultTwice) {
  std::mt19937 generator(15);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Isometry3d pose = forward(random_joints(&generator));
    const JointVector seed = random_joints(&generator);
    ASSERT_EQ(inverse(pose, seed).q, inverse(pose, seed).q);
  }
}

TEST(JacoInverse, SaysOutOfReachAndKeepsTheSeed) {
  Eigen::Isometry3d pose = stand_off_pose();
  pose.translation().x() = 1.2;
  const IkResult result = inverse(pose, ready_joints());
  EXPECT_EQ(result.status, IkStatus::kOutOfReach);
  EXPECT_EQ(result.q, ready_joints());
  EXPECT_NEAR(result.position_error,
              (forward(ready_joints()).translation() - pose.translation()).norm(), 1e-12);
}

TEST(JacoInverse, SaysThatNoSolutionLiesWithinLimits) {
  // The forearm folded onto the upper arm by more than joint 4 allows: W 0.15 m from the shoulder.
  Eigen::Isometry3d pose = stand_off_pose();
  pose.translation() << 0.15 + 0.26375, 0.0, 0.2755;
  const IkResult result = inverse(pose, ready_joints());
  EXPECT_EQ(result.status, IkStatus::kNoSolutionWithinLimits);
  EXPECT_EQ(result.q, ready_joints());
}

TEST(JacoInverseAtArmAngle, ContainsTheConfigurationOfTheArmAngle) {
  std::mt19937 generator(16);
  int tested = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const JointVector q = random_joints(&generator);
    // Near q2 = pi the 1.6 mm offset decides the branch, and one arm angle may have none.
    if (std::abs(q[1] - M_PI) < 0.05) continue;
    ++tested;
    double nearest = std::numeric_limits<double>::infinity();
    for (const IkSolution& solution : inverse_at_arm_angle(forward(q), arm_angle(q))) {
      nearest = std::min(nearest, wrapped_distance(solution.q, q));
    }
    ASSERT_LT(nearest, 1e-6) << q.transpose();
  }
  EXPECT_GT(tested, 1900);
}

TEST(JacoInverseAtArmAngle, GivesEightExactBranchesInOrder) {
  const auto solutions = inverse_at_arm_angle(stand_off_pose(), 1.2);
  ASSERT_EQ(solutions.size(), 8u);
  for (int branch = 0; branch < 8; ++branch) {
    const IkSolution& solution = solutions[static_cast<std::size_t>(branch)];
    EXPECT_EQ(solution.branch, branch);
    EXPECT_EQ(solution.within_limits, inside_limits(solution.q));
    EXPECT_LT((forward(solution.q).matrix() - stand_off_pose().matrix()).norm(), kTolerance);
    EXPECT_NEAR(std::remainder(arm_angle(solution.q) - 1.2, 2.0 * M_PI), 0.0, 1e-6);
    for (int other = 0; other < branch; ++other) {
      EXPECT_GT(wrapped_distance(solution.q, solutions[static_cast<std::size_t>(other)].q), 0.1);
    }
  }
}

}  // namespace
}  // namespace jaco_kinematics
