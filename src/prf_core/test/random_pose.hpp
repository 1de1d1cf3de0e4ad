// SPDX-License-Identifier: BSD-3-Clause
// Random poses and rotations for the tests.
#pragma once

#include <random>

#include "prf_core/se3.hpp"

namespace prf_core {

inline Eigen::Vector3d random_vector(std::mt19937& random, double bound) {
  std::uniform_real_distribution<double> value(-bound, bound);
  const double x = value(random), y = value(random), z = value(random);
  return {x, y, z};
}

inline Eigen::Quaterniond random_rotation(std::mt19937& random) {
  std::normal_distribution<double> value;
  const double w = value(random), x = value(random), y = value(random), z = value(random);
  return Eigen::Quaterniond(w, x, y, z).normalized();
}

inline Pose random_pose(std::mt19937& random) {
  return {random_vector(random, 2.0), random_rotation(random)};
}

inline MovingPose random_moving_pose(std::mt19937& random) {
  return {random_pose(random), random_vector(random, 1.0), random_vector(random, 1.0)};
}

}  // namespace prf_core
