// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "jaco_kinematics/jaco_kinematics.hpp"
#include "random_joints.hpp"

namespace jaco_kinematics {
namespace {

constexpr double kTolerance = 1e-9;

// Errors of an answer, evaluated here and not taken from it.
void expect_meets(const Eigen::Isometry3d& pose, const IkResult& result) {
  ASSERT_EQ(result.status, IkStatus::kSolved);
  ASSERT_TRUE(inside_limits(result.q)) << result.q.transpose();
  const Eigen::Isometry3d reached = forward(result.q);
  ASSERT_LT((reached.translation() - pose.translation()).norm(), kTolerance);
  // |R_1 - R_2| is sqrt(2) times the angle between them, for a small one.
  ASSERT_LT((reached.linear() - pose.linear()).norm() / std::sqrt(2.0), kTolerance);
}

JointVector ready_joints() {
  return (JointVector() << 0.98, 2.32, 1.29, 1.39, -0.84, 2.23, -1.48).finished();
}

double wrapped_distance(const JointVector& a, const JointVector& b) {
  double largest = 0.0;
  for (int i = 0; i < 7; ++i) {
    largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2.0 * M_PI)));
  }
  return largest;
}

TEST(JacoInverse, SolvesReachablePosesFromAFarSeed) {
  std::mt19937 generator(11);
  int solved = 0;
  constexpr int kPoses = 10000;
  for (int trial = 0; trial < kPoses; ++trial) {
    const Eigen::Isometry3d pose = forward(random_joints(&generator));
    const IkResult result = inverse(pose, ready_joints());
    if (result.status != IkStatus::kSolved) continue;
    ++solved;
    ASSERT_NO_FATAL_FAILURE(expect_meets(pose, result));
  }
  EXPECT_GE(solved, kPoses * 999 / 1000);
  RecordProperty("solved", solved);
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
  params.null_space_step = 0.0;
  for (int trial = 0; trial < 1000; ++trial) {
    const JointVector q = random_joints(&generator);
    const IkResult result = inverse(forward(q), q, params);
    ASSERT_EQ(result.status, IkStatus::kSolved);
    ASSERT_LT((result.q - q).norm(), 1e-6) << q.transpose();
  }
}

// The configuration the pose was made from is a solution, so the answer must not be farther.
TEST(JacoInverse, PrefersTheSolutionNearestToTheSeed) {
  constexpr int kPoses = 2000;
  IkParams params;
  params.limit_weight = 0.0;
  params.null_space_step = 0.0;
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

TEST(JacoInverse, AnswersInTheSeedsTurn) {
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

// What the least joint motion for the same change of pose is at most, with room for the pull away
// from limits. It is large only where the arm is singular.
double step_bound(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to,
                  const JointVector& q) {
  constexpr double kRoom = 2.0;
  constexpr double kPull = 0.01;
  const double angle = Eigen::AngleAxisd(to.linear() * from.linear().transpose()).angle();
  const double change = std::hypot((to.translation() - from.translation()).norm(), angle);
  return kPull + kRoom * change / jacobian(q).jacobiSvd().singularValues()[5];
}

// Smooth random joint paths, followed with each answer as the next seed.
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
    JointVector q = joints_at(0);
    for (int step = 1; step <= kSteps; ++step) {
      const Eigen::Isometry3d pose = forward(joints_at(step));
      const IkResult result = inverse(pose, q);
      ASSERT_NO_FATAL_FAILURE(expect_meets(pose, result));
      ASSERT_LT((result.q - q).norm(), step_bound(forward(q), pose, q))
          << "path " << path << " step " << step;
      q = result.q;
    }
  }
}

TEST(JacoInverse, PassesTheShouldersSingularityWithoutAJump) {
  constexpr int kSteps = 400;     // the given path moves no joint by more than 0.005 rad a step
  constexpr double kJump = 0.06;  // [rad]; an exchange of branches turns a joint by much more
  int passed = 0;
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
    JointVector q = joints_at(0);
    for (int step = 1; step <= kSteps; ++step) {
      const Eigen::Isometry3d pose = forward(joints_at(step));
      const IkResult result = inverse(pose, q);
      ASSERT_NO_FATAL_FAILURE(expect_meets(pose, result));
      ASSERT_LT((result.q - q).cwiseAbs().maxCoeff(), kJump) << "path " << path << " step " << step;
      q = result.q;
    }
    if (q[1] > M_PI + 0.1) ++passed;
  }
  EXPECT_GE(passed, 25);
}

TEST(JacoInverse, MovesAwayFromALimitWhileThePoseStands) {
  JointVector q = ready_joints();
  q[1] = jaco_joint_limits().lower[1] + 0.05;
  const Eigen::Isometry3d pose = forward(q);
  const double before = q[1];
  for (int tick = 0; tick < 200; ++tick) {
    const IkResult result = inverse(pose, q);
    ASSERT_NO_FATAL_FAILURE(expect_meets(pose, result));
    q = result.q;
  }
  EXPECT_GT(q[1], before + 0.05);
}

// Each answer is the next seed, the pose stands.
void drift(int calls, JointVector* q) {
  IkParams params;
  params.limit_weight = 0.0;
  const Eigen::Isometry3d pose = forward(*q);
  for (int call = 0; call < calls; ++call) {
    const IkResult result = inverse(pose, *q, params);
    ASSERT_NO_FATAL_FAILURE(expect_meets(pose, result));
    ASSERT_LE((result.q - *q).norm(), params.null_space_step + 1e-6) << "call " << call;
    *q = result.q;
  }
}

TEST(JacoInverse, DriftsFromSingularitiesAndLimitsInSmallSteps) {
  constexpr int kCalls = 4000;
  for (const int joint : {1, 5}) {
    const double range = jaco_joint_limits().upper[joint] - M_PI;
    for (const double side : {-1.0, 1.0}) {
      JointVector q = ready_joints();
      q[joint] = M_PI + 0.2 * side;
      ASSERT_NO_FATAL_FAILURE(drift(kCalls, &q));
      EXPECT_GT(side * (q[joint] - M_PI), 0.35) << "joint " << joint + 1 << " side " << side;
      q = ready_joints();
      q[joint] = M_PI + side * (range - 0.2);
      ASSERT_NO_FATAL_FAILURE(drift(kCalls, &q));
      EXPECT_LT(side * (q[joint] - M_PI), range - 0.35)
          << "joint " << joint + 1 << " side " << side;
    }
  }
}

TEST(JacoInverse, DoesNotDriftInTheMiddle) {
  JointVector q = ready_joints();
  ASSERT_NO_FATAL_FAILURE(drift(100, &q));
  EXPECT_LT((q - ready_joints()).norm(), 1e-9);
}

TEST(JacoInverse, GivesTheSameAnswerTwice) {
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

TEST(JacoInverse, RefusesWhatIsNoPoseSeedOrOption) {
  const JointVector seed = ready_joints();
  Eigen::Isometry3d pose = stand_off_pose();
  pose.translation().y() = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)inverse(pose, seed), std::invalid_argument);
  EXPECT_THROW((void)inverse_at_arm_angle(pose, 0.0), std::invalid_argument);

  pose = stand_off_pose();
  pose.linear() *= 1.01;
  EXPECT_THROW((void)inverse(pose, seed), std::invalid_argument);
  pose = stand_off_pose();
  pose.linear().col(2) *= -1.0;
  EXPECT_THROW((void)inverse(pose, seed), std::invalid_argument);

  pose = stand_off_pose();
  JointVector bad_seed = seed;
  bad_seed[6] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)inverse(pose, bad_seed), std::invalid_argument);
  EXPECT_THROW((void)inverse_at_arm_angle(pose, std::nan("")), std::invalid_argument);

  IkParams params;
  params.weight[2] = 0.0;
  EXPECT_THROW((void)inverse(pose, seed, params), std::invalid_argument);
  params = IkParams();
  params.limit_margin = -0.1;
  EXPECT_THROW((void)inverse(pose, seed, params), std::invalid_argument);
  params = IkParams();
  params.null_space_margin = 0.0;
  EXPECT_THROW((void)inverse(pose, seed, params), std::invalid_argument);
  params = IkParams();
  params.null_space_step = -1e-4;
  EXPECT_THROW((void)inverse(pose, seed, params), std::invalid_argument);
  params = IkParams();
  params.limit_weight = -1.0;
  EXPECT_THROW((void)inverse(pose, seed, params), std::invalid_argument);
}

}  // namespace
}  // namespace jaco_kinematics
