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
  // Slope of the null-space objective (of order one) below which its step is shortened, so that it
  // ends without chatter where the objective is least.
  constexpr double kGentleSlope = 0.03;
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
  double length = direction.dot(descent) / curvature;
  const double slope = null_space_slope(q, direction);
  length += params_.null_space_step * slope / std::hypot(slope, kGentleSlope);
  return length;
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

// The null-space objective keeps joints 2 and 6 away from their limits and from their singularity
// at pi. Its slope along the direction, of each joint 0 from null_space_margin on and at most 1.
// (Joint 4 does not depend on the self-motion.)
double IkCost::null_space_slope(const JointVector& q, const JointVector& direction) const {
  constexpr double kPeak = 2.598;  // 3 sqrt(3) / 2, which is 1 / max of u (1 - u^2)
  double sum = 0.0;
  for (int i : {1, 5}) {
    const double from_pi = q[i] - kPi;
    const double to_limit = jaco_joint_limits().upper[i] - kPi - std::abs(from_pi);
    const double u = from_pi / params_.null_space_margin;
    const double away = std::abs(u) < 1.0 ? kPeak * u * (1.0 - u * u) : 0.0;
    const double depth = std::clamp(1.0 - to_limit / params_.null_space_margin, 0.0, 1.0);
    sum += direction[i] * (away - std::copysign(depth, from_pi));
  }
  return sum;
}

}  // namespace jaco_kinematics
