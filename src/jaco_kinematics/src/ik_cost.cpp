// SPDX-License-Identifier: BSD-3-Clause
#include "ik_cost.hpp"

#include <algorithm>
#include <cmath>

#include "closed_form.hpp"

namespace jaco_kinematics {

double IkCost::value(const JointVector& q) const {
  double sum = (q - seed_).cwiseAbs2().dot(params_.weight);
  for (int i : {1, 3, 5}) {
    const double depth = limit_depth(q, i);
    sum += params_.limit_weight * depth * depth;
  }
  return sum;
}

double IkCost::self_motion(const JointVector& q, const JointVector& direction) const {
  // Half of minus the cost's gradient and half of its second derivative along the direction.
  JointVector descent = params_.weight.cwiseProduct(seed_ - q);
  double curvature = direction.cwiseAbs2().dot(params_.weight);
  for (int i : {1, 3, 5}) {
    const double depth = limit_depth(q, i);
    if (depth == 0.0) continue;
    const double inward = q[i] < kPi ? 1.0 : -1.0;
    const double slope = direction[i] / params_.limit_margin;
    descent[i] += inward * params_.limit_weight * depth / params_.limit_margin;
    curvature += params_.limit_weight * slope * slope;
  }
  return direction.dot(descent) / curvature;
}

JointVector IkCost::unwrapped(const JointVector& q) const {
  JointVector result = normalized_angles(q);
  for (int i : {0, 2, 4, 6}) result[i] = seed_[i] + wrap_angle(q[i] - seed_[i]);
  return result;
}

// 0 at limit_margin from the nearer limit and beyond, 1 at the limit. Limits are symmetric about
// pi.
double IkCost::limit_depth(const JointVector& q, int joint) const {
  const double distance = jaco_joint_limits().upper[joint] - kPi - std::abs(q[joint] - kPi);
  return std::max(0.0, 1.0 - distance / params_.limit_margin);
}

}  // namespace jaco_kinematics
