// SPDX-License-Identifier: BSD-3-Clause
// Joint velocities that move the hand as wanted, as far as the joints' limits allow.
//
//   minimise over v   |W (J v - x)|^2 + kNullSpaceWeight |v - v_p|^2      lower <= v <= upper
//
// with W = diag(1, 1, 1, w, w, w). A joint at its limit is made up for by the others, first at the
// cost of the posture, then of the hand's orientation. Scaling all joints alike instead would leave
// the hand behind: one joint out of seven that asks for twice its limit halves the hand's speed.
// (Resolved-rate control as a bounded least squares problem, after Whitney 1969; Escande,
// Mansard and Wieber 2014.)
#pragma once

#include <jaco_kinematics/jaco_kinematics.hpp>

#include "prf_control/joint_motion.hpp"

namespace prf_control {

using Twist = Eigen::Matrix<double, 6, 1>;  // linear [m/s], then angular [rad/s]

// [m^2/rad^2] Joint motions that move the hand by less than 0.1 m/rad belong to the posture: near a
// singularity they would be fast and gain nothing.
inline constexpr double kNullSpaceWeight = 0.01;

struct ResolvedRateProblem {
  jaco_kinematics::Jacobian jacobian;  // J, at the joints as they are
  Twist twist;                         // x
  JointVector null_space_velocity;     // v_p [rad/s], toward the joints that are wanted
  double orientation_weight = 0.0;     // w [m/rad], > 0
};

// The one minimum, to 1e-9 rad/s unless the Jacobian is worse conditioned than that.
[[nodiscard]] JointVector resolved_rate(const ResolvedRateProblem& request,
                                        const VelocityRange& range);

}  // namespace prf_control
