// SPDX-License-Identifier: BSD-3-Clause
// Forward and inverse kinematics of the Kinova Jaco2 with 7 joints and a spherical wrist
// (j2s7s300), in closed form. This is the only header to include:
//
//   const IkResult result = inverse(hand_in_base, joints_now);
//   if (result.status == IkStatus::kSolved) command(result.q);
//
// The hand is the frame j2s7s300_end_effector, its base j2s7s300_link_base.
//
//   forward:  T(q)  = pose of the hand in the base
//   inverse:  q     with T(q) = pose; one joint more than the pose needs, so the solutions are
//                   up to 8 branches, each a curve over the arm angle phi
//
// Arm angle: with the shoulder S, the wrist centre W and the elbow E, phi is the right-handed angle
// about S->W from the upward vertical (made normal to S->W) to the direction of E. Where W lies
// above or below S, the base's x axis takes the place of the vertical.
//
// Metres, radians. Joints 1, 3, 5 and 7 are continuous; 2, 4 and 6 lie in [0, 2 pi).
// All functions are pure. They throw std::invalid_argument for input that is not finite, for angles
// beyond kLargestAngle and translations beyond kLargestDistance, and for a pose whose rotation is
// not orthonormal to 1e-6. Joints outside their limits are no error: forward() and jacobian() take
// them, and as a seed they are a place to start from.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace jaco_kinematics {

// [rad], [m] Beyond any arm; up to there an angle is exact to 2e-12 rad.
inline constexpr double kLargestAngle = 1e4;
inline constexpr double kLargestDistance = 1e4;

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

// Geometric Jacobian of the hand in the base, linear rows first.
Jacobian jacobian(const JointVector& q);

// Arm angle of a configuration, in (-pi, pi].
double arm_angle(const JointVector& q);

// [rad] Ours: the arm angle of the preferred posture, the elbow low on the side of joint 1's
// positive turn.
inline constexpr double kPreferredArmAngle = 2.7;

// Self-motion toward the preferred posture: a joint motion of norm below 1 that leaves the hand in
// place, toward kPreferredArmAngle and away from the limits of joints 2 and 6. It goes to zero in
// the posture, which depends on the hand's pose alone: with it, hand motions that come back bring
// the joints back.
JointVector posture_motion(const JointVector& q);

struct IkSolution {
  int branch;                // 4 * shoulder + 2 * elbow + wrist, each 0 or 1; shoulder is 0 for q2
                             // in [0, pi], wrist is 0 for q6 in [0, pi]
  JointVector q;             // continuous joints in (-pi, pi], the others in [0, 2 pi)
  bool within_limits;        // of joints 2, 4 and 6
  double position_error;     // [m]
  double orientation_error;  // [rad]
};

// Every branch that exists at one arm angle, ordered by `branch`; limits are reported, not applied.
std::vector<IkSolution> inverse_at_arm_angle(const Eigen::Isometry3d& pose, double phi);

enum class IkStatus { kSolved, kOutOfReach, kNoSolutionWithinLimits };

// The cost of a solution is its squared distance from the seed plus a small penalty near the joint
// limits. inverse() seeks the least cost, but does not guarantee it: it returns the local minimum
// if that is within 0.35 rad of the seed, otherwise the cheapest of at most 4 solutions.
struct IkParams {
  // Squared distance is sum_i weight_i (q_i - seed_i)^2, 1e-3 to 1e3. The default measures time of
  // travel relative to the slowest joints: (36 deg/s / 48 deg/s)^2 = 0.5625.
  JointVector weight = (JointVector() << 1.0, 1.0, 1.0, 1.0, 0.5625, 0.5625, 0.5625).finished();
  // Penalty limit_weight * (1 - d / limit_margin)^2 for a joint at distance d < limit_margin of a
  // limit.
  double limit_margin = 0.3;    // [rad], 0.001 to pi
  double limit_weight = 0.001;  // [rad^2], 0 to 1000; small: continuity comes first

  void validate() const;
};

struct IkResult {
  IkStatus status;
  JointVector q;             // if not solved: the seed (inverse), pi for all joints (any_inverse)
  double arm_angle;          // [rad] of q
  double position_error;     // [m] of q
  double orientation_error;  // [rad] of q
};

// The solution of least cost within limits (see IkParams), continuous joints in the seed's turn.
// kSolved means that the errors are below 1e-9 m and 1e-9 rad.
[[nodiscard]] IkResult inverse(const Eigen::Isometry3d& pose, const JointVector& seed,
                               const IkParams& params = IkParams());

// The first solution within limits that is found, for a caller without a seed. It is the fastest,
// lies in the middle of a feasible arc of the arm angle where possible, and is not continuous from
// pose to pose.
[[nodiscard]] IkResult any_inverse(const Eigen::Isometry3d& pose);

}  // namespace jaco_kinematics
