// SPDX-License-Identifier: BSD-3-Clause
// Kinematics of any serial chain. The inverse is a damped least squares search within the limits,
//
//   (J^T W J + lambda I) dq = J^T W e,    lambda = c e^T W e,    lower <= q + dq <= upper
//
// (Levenberg-Marquardt with the damping of Sugihara, IEEE T-RO 27(5), 2011; the bounds by an active
// set in each step), from the seed and, where that ends in a local minimum, from random joints.
// docs/results/kinematics.md has figures beside other solvers.
#pragma once

#include "arm_kinematics/arm_kinematics.hpp"
#include "arm_kinematics/chain.hpp"

namespace arm_kinematics {

class ChainKinematics : public ArmKinematics {
 public:
  explicit ChainKinematics(Chain chain);

  [[nodiscard]] const Chain& chain() const { return chain_; }
  [[nodiscard]] const JointLimits& limits() const override { return chain_.limits; }
  [[nodiscard]] Eigen::Isometry3d forward(const JointVector& q) const override;
  [[nodiscard]] Placement placement(const JointVector& q) const override;
  [[nodiscard]] IkResult inverse(const Eigen::Isometry3d& pose, const JointVector& seed,
                                 const IkSearch& options = {}) const override;

 private:
  Chain chain_;
  double reach_;  // [m] the tip's greatest distance from the first joint is below it
};

}  // namespace arm_kinematics
