// SPDX-License-Identifier: BSD-3-Clause
// Kinematics of the Kinova j2s7s300 (Jaco2, 7 joints, spherical wrist) in closed form.
//
//   forward:  T(q)  = pose of j2s7s300_end_effector in j2s7s300_link_base
//   inverse:  q     with T(q) = pose, one-parameter family in the arm angle phi, 8 branches each
//
// Arm angle: with S the shoulder point, W the wrist centre and E the elbow, phi is the right-handed
// angle about S->W from the upward vertical (made normal to S->W) to the direction of E.
// Where W lies above or below S the vertical is replaced by the base's x axis.
//
// Units: metres, radians. Joints 1, 3, 5, 7 turn without end; 2, 4, 6 lie in [0, 2 pi).
// All functions are pure; std::invalid_argument for non-finite input or a pose that is no rotation.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace jaco_kinematics {

using JointVector = Eigen::Matrix<double, 7, 1>;
using Jacobian = Eigen::Matrix<double, 6, 7>;

struct JointLimits {
  JointVector lower;     // [rad], -infinity where the joint is continuous
  JointVector upper;     // [rad], +infinity where the joint is continuous
  JointVector velocity;  // [rad/s]
  JointVector effort;    // [N m]
};

const JointLimits& jaco_joint_limits();

Eigen::Isometry3d forward(const JointVector& q);

// Geometric Jacobian of the end-effector point in link_base, linear rows first.
Jacobian jacobian(const JointVector& q);

// Arm angle of a configuration, in (-pi, pi].
double arm_angle(const JointVector& q);

struct IkSolution {
  int branch;                // 4 * shoulder + 2 * elbow + wrist, each 0 or 1
  JointVector q;             // continuous joints in (-pi, pi], the others in [0, 2 pi)
  bool within_limits;        // of joints 2, 4 and 6
  double position_error;     // [m]
  double orientation_error;  // [rad]
};

// Every branch that exists at one arm angle, ordered by `branch`; limits are reported, not applied.
std::vector<IkSolution> inverse_at_arm_angle(const Eigen::Isometry3d& pose, double phi);

enum class IkStatus { kSolved, kOutOfReach, kNoSolutionWithinLimits };

struct IkParams {
  // Distance to the seed is sum_i weight_i (q_i - seed_i)^2; the default measures time of travel,
  // relative to the slowest joints (36 deg/s against 48 deg/s).
  JointVector weight = (JointVector() << 1.0, 1.0, 1.0, 1.0, 0.5625, 0.5625, 0.5625).finished();
  // Cost limit_weight * (1 - d / limit_margin)^2 for a joint at distance d < limit_margin of a
  // limit.
  double limit_margin = 0.3;    // [rad], > 0
  double limit_weight = 0.001;  // [rad^2], >= 0; small: continuity comes first
  // Beside that, at most null_space_step of self-motion from the nearest solution while joint 2 or
  // 6 is within null_space_margin of a limit or of its singularity at pi, away from there: with the
  // answer as the next seed, a steady drift.
  double null_space_margin = 0.5;   // [rad], > 0
  double null_space_step = 0.0004;  // [rad] in the norm of q, >= 0; 0.04 rad/s at 100 Hz

  void validate() const;
};

struct IkResult {
  IkStatus status;
  JointVector q;             // the seed if not solved
  double arm_angle;          // [rad] of q
  double position_error;     // [m] of q
  double orientation_error;  // [rad] of q
};

// The solution within limits that is nearest to the seed (continuous joints in the seed's turn)
// and, as a smaller part of the cost, away from limits. kSolved means errors below 1e-9.
[[nodiscard]] IkResult inverse(const Eigen::Isometry3d& pose, const JointVector& seed,
                               const IkParams& options = IkParams());

// The first solution within limits that is met, for whoever has no seed: in the middle of a
// feasible arc if it is there. The fastest; not continuous from pose to pose.
[[nodiscard]] IkResult any_inverse(const Eigen::Isometry3d& pose);

}  // namespace jaco_kinematics
