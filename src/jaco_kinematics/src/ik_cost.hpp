// SPDX-License-Identifier: BSD-3-Clause
// The cost by which inverse() chooses among the solutions of a pose. Private to the library.
//
//   cost(q) = sum_i weight_i (q_i - seed_i)^2
//             + limit_weight sum_{i = 2,4,6} max(0, 1 - d_i / limit_margin)^2
//
// with d_i the distance of joint i from its nearer limit.
#pragma once

#include "jaco_kinematics/jaco_kinematics.hpp"

namespace jaco_kinematics {

class IkCost {
 public:
  IkCost(const JointVector& seed, const IkParams& params) : seed_(seed), params_(params) {}

  [[nodiscard]] double value(const JointVector& q) const;

  // How far to go from q along a unit direction of self-motion [rad]: Newton's step to the least
  // cost.
  [[nodiscard]] double self_motion(const JointVector& q, const JointVector& direction) const;

  // Continuous joints in the turn nearest to the seed.
  [[nodiscard]] JointVector unwrapped(const JointVector& q) const;

 private:
  [[nodiscard]] double limit_depth(const JointVector& q, int joint) const;

  JointVector seed_;
  IkParams params_;
};

}  // namespace jaco_kinematics
