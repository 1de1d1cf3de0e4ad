// SPDX-License-Identifier: BSD-3-Clause
// What inverse() does with input that no arm has: it is refused, or the result is still a solution.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "expect_meets.hpp"
#include "jaco_kinematics/jaco_kinematics.hpp"
#include "random_joints.hpp"

namespace jaco_kinematics {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Fault 1, 43: a pose or seed that is not finite, absurd or no rotation -> refused, never solved
// wrongly
TEST(JacoInverseInputs, AreRefusedWhereTheyAreNoPoseOrSeed) {
  const JointVector seed = ready_joints();
  for (const double bad : {kNan, kInfinity, 1e300, -1.1e4}) {
    Eigen::Isometry3d pose = stand_off_pose();
    pose.translation().y() = bad;
    EXPECT_THROW((void)inverse(pose, seed), std::invalid_argument);
    EXPECT_THROW((void)any_inverse(pose), std::invalid_argument);
    EXPECT_THROW((void)inverse_at_arm_angle(pose, 0.0), std::invalid_argument);
    EXPECT_THROW((void)inverse_at_arm_angle(stand_off_pose(), bad), std::invalid_argument);
    JointVector bad_seed = seed;
    bad_seed[6] = bad;
    EXPECT_THROW((void)inverse(stand_off_pose(), bad_seed), std::invalid_argument);
  }
  Eigen::Isometry3d pose = stand_off_pose();
  pose.linear() *= 1.01;
  EXPECT_THROW((void)inverse(pose, seed), std::invalid_argument);
  pose = stand_off_pose();
  pose.linear().col(2) *= -1.0;
  EXPECT_THROW((void)inverse(pose, seed), std::invalid_argument);
  pose.linear().setConstant(1e200);
  EXPECT_THROW((void)inverse(pose, seed), std::invalid_argument);
  pose.linear().setZero();
  EXPECT_THROW((void)inverse(pose, seed), std::invalid_argument);
}

TEST(JacoInverseInputs, ASeedOfManyTurnsStillGivesAnExactSolution) {
  std::mt19937 generator(31);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Isometry3d pose = forward(random_joints(&generator));
    JointVector seed = ready_joints();
    for (const int i : {0, 2, 4, 6}) seed[i] += (i % 4 == 0 ? 1.0 : -1.0) * 9000.0;
    ASSERT_NO_FATAL_FAILURE(expect_meets(pose, inverse(pose, seed)));
  }
}

// Fault 37: joints outside their limits as seed -> the solution lies within limits, whatever the
// seed
TEST(JacoInverseInputs, ASeedOutsideItsLimitsGivesASolutionInside) {
  std::mt19937 generator(32);
  std::uniform_real_distribution<> anything(-20.0, 20.0);
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Isometry3d pose = forward(random_joints(&generator));
    const JointVector seed = JointVector::NullaryExpr([&] { return anything(generator); });
    ASSERT_NO_FATAL_FAILURE(expect_meets(pose, inverse(pose, seed))) << trial;
  }
}

// Fault 28, 52: a parameter beyond its bounds on either side -> refused
TEST(IkParams, RefuseValuesBeyondTheirBounds) {
  const std::vector<std::function<double*(IkParams&)>> members = {
      [](IkParams& params) { return &params.weight[2]; },
      [](IkParams& params) { return &params.limit_margin; },
      [](IkParams& params) { return &params.limit_weight; }};
  for (const auto& member : members) {
    for (const double bad : {-1e-9, 1e308, kNan, kInfinity}) {
      IkParams params;
      *member(params) = bad;
      EXPECT_THROW((void)inverse(stand_off_pose(), ready_joints(), params), std::invalid_argument)
          << bad;
    }
  }
}

}  // namespace
}  // namespace jaco_kinematics
