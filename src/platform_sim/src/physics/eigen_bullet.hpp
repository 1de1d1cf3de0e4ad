// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <LinearMath/btTransform.h>

#include <Eigen/Geometry>

namespace platform_sim {

inline btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline btQuaternion to_bullet(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

inline btTransform to_bullet(const Eigen::Isometry3d& pose) {
  return btTransform(to_bullet(Eigen::Quaterniond(pose.linear())),
                     to_bullet(Eigen::Vector3d(pose.translation())));
}

inline Eigen::Vector3d to_eigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

inline Eigen::Isometry3d to_eigen(const btTransform& transform) {
  const btMatrix3x3& basis = transform.getBasis();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row)
    pose.linear().row(row) = to_eigen(basis.getRow(row)).transpose();
  pose.translation() = to_eigen(transform.getOrigin());
  return pose;
}

}  // namespace platform_sim
