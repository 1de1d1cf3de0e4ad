// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/resolved_rate.hpp"

#include <algorithm>
#include <cmath>

namespace prf_control {
namespace {

constexpr int kMaxSweeps = 1000;      // ours: tens are used; bounds the time of a tick
constexpr double kConverged = 1e-10;  // [rad/s] of every joint; the commands' rounding is 1e-11

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                             arm_kinematics::kMaxJoints, arm_kinematics::kMaxJoints>;

// Coordinate descent on v^T H v / 2 - g^T v, which converges from anywhere as H is definite.
JointVector bounded_minimum(const Square& H, const JointVector& g, const VelocityRange& range) {
  JointVector v = H.ldlt().solve(g).cwiseMax(range.lower).cwiseMin(range.upper);
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    double change = 0.0;
    for (int i = 0; i < v.size(); ++i) {
      const double best = v[i] + (g[i] - H.row(i).dot(v)) / H(i, i);
      const double next = std::clamp(best, range.lower[i], range.upper[i]);
      change = std::max(change, std::abs(next - v[i]));
      v[i] = next;
    }
    if (change < kConverged) break;
  }
  return v;
}

}  // namespace

JointVector resolved_rate(const ResolvedRateProblem& problem, const VelocityRange& range) {
  Twist weight;
  weight << Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(problem.orientation_weight);
  const arm_kinematics::Jacobian A = weight.asDiagonal() * problem.jacobian;
  Square H = A.transpose() * A;
  H.diagonal().array() += kNullSpaceWeight;
  const JointVector g = A.transpose() * weight.cwiseProduct(problem.twist) +
                        kNullSpaceWeight * problem.null_space_velocity;
  return bounded_minimum(H, g, range);
}

}  // namespace prf_control
