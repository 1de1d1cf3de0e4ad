// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "jaco_kinematics/jaco_kinematics.hpp"
#include "random_joints.hpp"

namespace jaco_kinematics {

inline constexpr double kTolerance = 1e-9;

// Errors of a result, evaluated here and not taken from it.
inline void expect_meets(const Eigen::Isometry3d& pose, const IkResult& result) {
  ASSERT_EQ(result.status, IkStatus::kSolved);
  ASSERT_TRUE(inside_limits(result.q)) << result.q.transpose();
  const Eigen::Isometry3d reached = forward(result.q);
  ASSERT_LT((reached.translation() - pose.translation()).norm(), kTolerance);
  // |R_1 - R_2| is sqrt(2) times the angle between them, for a small one.
  ASSERT_LT((reached.linear() - pose.linear()).norm() / std::sqrt(2.0), kTolerance);
}

// The arm ready in front, from which a skill begins.
inline JointVector ready_joints() {
  return (JointVector() << 0.98, 2.32, 1.29, 1.39, -0.84, 2.23, -1.48).finished();
}

}  // namespace jaco_kinematics
