// SPDX-License-Identifier: BSD-3-Clause
// Resolved-rate step: joint velocities that give the hand a wanted velocity, as far as the limits
// of the joints allow.
//
//   minimise over v   |W (J v - x)|^2 + kNullSpaceWeight |v - v_n|^2      lower <= v <= upper
//
// with W = diag(1, 1, 1, w, w, w). What the hand's velocity x leaves free goes to the null-space
// objective v_n. Where a joint is at its limit, the others compensate: first v_n is given up, then
// the hand's orientation. Scaling all joints alike instead would leave the hand behind: one joint
// of the arm that needs twice its limit would halve the hand's speed.
// (Whitney 1969, as a bounded least squares problem after Escande, Mansard and Wieber 2014.)
#pragma once

#include "prf_control/joint_motion.hpp"

namespace prf_control {

using arm_kinematics::Twist;  // linear [m/s], then angular [rad/s]

// [m^2/rad^2] Ours. Joint motions that move the hand by less than 0.1 m/rad belong to the null
// space: near a singularity they would be fast and gain nothing.
inline constexpr double kNullSpaceWeight = 0.01;

struct ResolvedRateProblem {
  arm_kinematics::Jacobian jacobian;  // J, at the present joints
  Twist twist;                        // x, wanted velocity of the hand
  JointVector null_space_velocity;    // v_n [rad/s]
  double orientation_weight = 0.0;    // w [m/rad], > 0
};

// The minimum, which is unique, to 1e-9 rad/s unless the Jacobian is worse conditioned than that.
[[nodiscard]] JointVector resolved_rate(const ResolvedRateProblem& problem,
                                        const VelocityRange& range);

}  // namespace prf_control
