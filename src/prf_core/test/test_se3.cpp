// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/se3.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace prf_core {
namespace {

// Circle of 0.1 m at 2 rad/s while turning about z at 0.7 rad/s.
MovingPose circling(double t) {
  MovingPose at;
  at.pose.position = {0.1 * std::cos(2 * t), 0.1 * std::sin(2 * t), 0.5};
  at.pose.orientation = Eigen::AngleAxisd(0.7 * t, Eigen::Vector3d::UnitZ());
  at.linear_velocity = {-0.2 * std::sin(2 * t), 0.2 * std::cos(2 * t), 0};
  at.angular_velocity = {0, 0, 0.7};
  return at;
}

TEST(RigidlyAttached, HasTheVelocityOfARigidBody) {
  const Pose lever{{-0.3, 0.1, 0.05}, {0.5, 0.5, 0.5, 0.5}};
  const double h = 1e-6;
  const MovingPose before = rigidly_attached(circling(0.3 - h), lever);
  const MovingPose at = rigidly_attached(circling(0.3), lever);
  const MovingPose after = rigidly_attached(circling(0.3 + h), lever);
  const Eigen::Vector3d slope = (after.pose.position - before.pose.position) / (2 * h);
  EXPECT_LT((at.linear_velocity - slope).norm(), 1e-8);
  const Eigen::Vector3d turn =
      rotation_between(before.pose.orientation, after.pose.orientation) / (2 * h);
  EXPECT_LT((at.angular_velocity - turn).norm(), 1e-6);
}

TEST(RotationBetween, TakesTheShortWay) {
  const Eigen::Quaterniond from(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  Eigen::Quaterniond to(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  to.coeffs() = -to.coeffs();
  EXPECT_LT((rotation_between(from, to) - Eigen::Vector3d(0.3, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(rotation_between(from, from).norm(), 0);
}

TEST(ExpSo3, IsTheInverseOfLog) {
  for (const double angle : {0.0, 1e-12, 1e-6, 0.3, 3.1}) {
    const Eigen::Vector3d rotation = angle * Eigen::Vector3d(2, -1, 2) / 3;
    EXPECT_LT((log_so3(Eigen::Quaterniond(exp_so3(rotation))) - rotation).norm(), 1e-12) << angle;
  }
}

}  // namespace
}  // namespace prf_core
