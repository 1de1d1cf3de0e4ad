// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>

#include "jaco_kinematics/jaco_kinematics.hpp"

namespace jaco_kinematics {

// Uniform within limits, a full turn for the continuous joints.
inline JointVector random_joints(std::mt19937* generator) {
  const JointLimits& limits = jaco_joint_limits();
  JointVector q;
  for (int i = 0; i < 7; ++i) {
    const double lower = std::isfinite(limits.lower[i]) ? limits.lower[i] : -M_PI;
    const double upper = std::isfinite(limits.upper[i]) ? limits.upper[i] : M_PI;
    q[i] = std::uniform_real_distribution<>(lower, upper)(*generator);
  }
  return q;
}

inline bool inside_limits(const JointVector& q) {
  const JointLimits& limits = jaco_joint_limits();
  return (q.array() >= limits.lower.array()).all() && (q.array() <= limits.upper.array()).all();
}

// The demonstrated stand-off: camera above the hand, looking along x of the arm's base.
inline Eigen::Isometry3d stand_off_pose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << 0.616, 0.0, 0.585;
  pose.linear().col(0) = Eigen::Vector3d::UnitY();
  pose.linear().col(1) = Eigen::Vector3d::UnitZ();
  pose.linear().col(2) = Eigen::Vector3d::UnitX();
  return pose;
}

}  // namespace jaco_kinematics
