// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/nearest_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <random>
#include <stdexcept>

#include "follower_limits.hpp"

namespace prf_control {
namespace {

using arm_kinematics::JointVector;
using jaco_kinematics::forward;
using jaco_kinematics::jaco_joint_limits;

constexpr double kWeight = 0.2;

JointVector random_posture(std::mt19937& random) {
  std::uniform_real_distribution<double> turn(-M_PI, M_PI);
  std::uniform_real_distribution<double> bend(-1.5, 1.5);
  JointVector q(7);
  for (int i = 0; i < 7; ++i) q[i] = i % 2 == 0 ? turn(random) : M_PI + bend(random);
  return q;
}

double cost(const JointVector& q, const Eigen::Isometry3d& pose) {
  Eigen::Matrix<double, 6, 1> error = pose_error(forward(q), pose);
  error.tail<3>() *= kWeight;
  return error.norm();
}

void expect_within_limits(const JointVector& q) {
  EXPECT_TRUE(q.allFinite());
  EXPECT_GE((q - jaco_joint_limits().lower).minCoeff(), 0.0);
  EXPECT_GE((jaco_joint_limits().upper - q).minCoeff(), 0.0);
}

TEST(PoseError, IsTheTranslationAndRotationVectorBetweenTwoPoses) {
  Eigen::Isometry3d from = Eigen::Isometry3d::Identity();
  from.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
  const Eigen::Vector3d turn(0.3, -0.2, 0.1);
  Eigen::Isometry3d to = from;
  to.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * from.linear();
  to.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  const auto error = pose_error(from, to);
  EXPECT_TRUE(error.head<3>().isApprox(Eigen::Vector3d(0.1, 0.2, 0.3), 1e-14));
  EXPECT_TRUE(error.tail<3>().isApprox(turn, 1e-14));
}

TEST(NearestPose, FindsAPoseThatCanBeReached) {
  std::mt19937 random(3);
  std::normal_distribution<double> small(0.0, 0.1);
  for (int i = 0; i < 100; ++i) {
    const JointVector q = random_posture(random);
    const JointVector start = q + JointVector::NullaryExpr(7, [&] { return small(random); });
    const JointVector found = nearest_pose(*jaco(), forward(q), start, kWeight);
    expect_within_limits(found);
    EXPECT_LE(cost(found, forward(q)), 1e-5);
  }
}

// A hand pointing away from the shoulder, farther than the stretched arm: the answer stretches.
TEST(NearestPose, StretchesTowardAPoseStraightOutOfReach) {
  const Eigen::Vector3d shoulder(0.0, 0.0, 0.2755);
  JointVector start(7);
  start << 0.0, 3.9, 0.0, 2.4, 0.0, 3.4, 0.0;
  for (const double distance : {1.0, 1.1, 1.5, 3.0}) {
    Eigen::Isometry3d pose = forward(start);
    pose.linear() = Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5).toRotationMatrix();  // z along x
    pose.translation() = shoulder + Eigen::Vector3d(distance, 0.0, 0.0);
    const JointVector found = nearest_pose(*jaco(), pose, start, kWeight);
    expect_within_limits(found);
    const auto error = pose_error(forward(found), pose);
    EXPECT_NEAR(error.head<3>().norm(), distance - 0.985, 2e-3) << distance;
    EXPECT_LE(error.tail<3>().norm(), 0.03) << distance;
  }
}

TEST(NearestPose, IsStationaryUnlessAJointLimitHoldsIt) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  int free = 0;
  for (int i = 0; i < 100; ++i) {
    Eigen::Isometry3d pose = forward(random_posture(random));
    pose.translation() = Eigen::Vector3d(place(random), place(random), place(random));
    const JointVector found = nearest_pose(*jaco(), pose, random_posture(random), kWeight);
    expect_within_limits(found);
    Eigen::Matrix<double, 6, 1> error = pose_error(forward(found), pose);
    error.tail<3>() *= kWeight * kWeight;
    const JointVector slope = -jaco_kinematics::jacobian(found).transpose() * error;
    for (int j = 0; j < 7; ++j) {
      const bool at_lower = found[j] - jaco_joint_limits().lower[j] < 1e-9;
      const bool at_upper = jaco_joint_limits().upper[j] - found[j] < 1e-9;
      // Downhill must lead out of the limits, or nowhere.
      EXPECT_TRUE(at_lower || slope[j] <= 1e-4) << i << " joint " << j + 1 << " " << slope[j];
      EXPECT_TRUE(at_upper || slope[j] >= -1e-4) << i << " joint " << j + 1 << " " << slope[j];
      free += !at_lower && !at_upper;
    }
  }
  EXPECT_GT(free, 400);
}

TEST(NearestPose, IsNeverWorseThanItsStartAndStaysWhenCalledAgain) {
  std::mt19937 random(5);
  for (int i = 0; i < 50; ++i) {
    Eigen::Isometry3d pose = forward(random_posture(random));
    pose.translation() *= 2.0;
    const JointVector start = random_posture(random);
    const JointVector found = nearest_pose(*jaco(), pose, start, kWeight);
    EXPECT_LE(cost(found, pose), cost(start, pose));
    const JointVector again = nearest_pose(*jaco(), pose, found, kWeight);
    EXPECT_LE((again - found).cwiseAbs().maxCoeff(), 1e-2);
  }
}

// Fault 24, 43: a set-point a kilometre away -> the nearest pose within half a turn of each joint,
// not one many turns off
TEST(NearestPose, StaysWithinHalfATurnHoweverFarThePoseIs) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  for (int trial = 0; trial < 300; ++trial) {
    const JointVector start = random_posture(random);
    Eigen::Isometry3d pose = forward(start);
    pose.translation() = 900.0 * Eigen::Vector3d(place(random), place(random), place(random));
    const JointVector q = nearest_pose(*jaco(), pose, start, kWeight);
    for (const int i : {0, 2, 4, 6}) ASSERT_LE(std::abs(q[i] - start[i]), M_PI + 1e-9) << trial;
  }
}

TEST(NearestPose, RefusesInputThatIsNotFinite) {
  const JointVector start = JointVector::Constant(7, M_PI);
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.translation().x() = std::nan("");
  EXPECT_THROW(nearest_pose(*jaco(), bad, start, kWeight), std::invalid_argument);
  EXPECT_THROW(nearest_pose(*jaco(), Eigen::Isometry3d::Identity(),
                            JointVector::Constant(7, std::nan("")), kWeight),
               std::invalid_argument);
  EXPECT_THROW(nearest_pose(*jaco(), Eigen::Isometry3d::Identity(), start, 0.0),
               std::invalid_argument);
}

}  // namespace
}  // namespace prf_control
