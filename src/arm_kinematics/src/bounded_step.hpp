// SPDX-License-Identifier: BSD-3-Clause
// Private: one damped least squares step within bounds.
#pragma once

#include <optional>

#include "arm_kinematics/arm_kinematics.hpp"

namespace arm_kinematics {

using JointMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxJoints, kMaxJoints>;

// Minimises 1/2 x^T H x - g^T x over lower <= x <= upper for positive definite H, approximately: a
// component that would leave its bound is put on it, and the others are solved for again.
// lower <= 0 <= upper. None where H is found not to be positive definite.
std::optional<JointVector> bounded_step(const JointMatrix& h, const JointVector& g,
                                        const JointVector& lower, const JointVector& upper);

}  // namespace arm_kinematics
