// SPDX-License-Identifier: BSD-3-Clause
// The joint position within limits whose pose is nearest to one that cannot be reached.
//
//   minimise over q   |p(q) - p|^2 + (orientation_weight angle(R(q), R))^2    lower <= q <= upper
//
// A local search (NLopt, SLSQP) from `start`: the answer is continuous with it and never worse.
#pragma once

#include <arm_kinematics/arm_kinematics.hpp>

namespace prf_control {

// [p_to - p_from (m); rotation vector of R_to R_from^T (rad)], in the common frame.
Eigen::Matrix<double, 6, 1> pose_error(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

// `orientation_weight` [m/rad]: how many metres one radian is worth, > 0.
arm_kinematics::JointVector nearest_pose(const arm_kinematics::ArmKinematics& arm,
                                         const Eigen::Isometry3d& hand_in_base,
                                         const arm_kinematics::JointVector& start,
                                         double orientation_weight);

}  // namespace prf_control
