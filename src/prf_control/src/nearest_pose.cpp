// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/nearest_pose.hpp"

#include <algorithm>
#include <cmath>
#include <nlopt.hpp>
#include <prf_core/se3.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace prf_control {
namespace {

using arm_kinematics::ArmKinematics;
using arm_kinematics::JointVector;
using ErrorVector = Eigen::Matrix<double, 6, 1>;

// Bounds the work of one call; a search that has not ended goes on from there in the next tick.
constexpr int kMaxEvaluations = 300;
// The cost is divided by (0.1 m)^2, so that it and its curvature are of order one.
constexpr double kCostScale = 100.0;
constexpr double kTurn = 2.0 * M_PI;
constexpr double kFar = 100.0;  // [rad] for a joint in the search

struct Problem {
  const ArmKinematics& arm;
  JointVector start;
  Eigen::Isometry3d hand_in_base;
  ErrorVector weight;
  JointVector best;
  double best_cost;
};

// f = 1/2 e^T W^2 e with e = pose_error(T(q), T). A rotation vector is mapped to itself by the
// inverse left Jacobian of SO(3), so the gradient is -J^T W^2 e exactly.
double cost(const JointVector& q, const Problem& problem, JointVector* gradient) {
  const ErrorVector error =
      pose_error(problem.arm.forward(q), problem.hand_in_base).cwiseProduct(problem.weight);
  if (gradient != nullptr) {
    *gradient =
        -kCostScale * problem.arm.jacobian(q).transpose() * error.cwiseProduct(problem.weight);
  }
  return 0.5 * kCostScale * error.squaredNorm();
}

// Continuous joints that are farther than `bound` from the start, in the turn nearest to it: the
// search may try any angle, and the arm need not turn more than once.
JointVector near_start(const JointVector& q, const Problem& problem, double bound) {
  JointVector result = q;
  const JointVector& start = problem.start;
  for (int i = 0; i < q.size(); ++i) {
    const bool continuous = std::isinf(problem.arm.limits().upper[i]);
    const double way = q[i] - start[i];
    if (continuous && !(std::abs(way) <= bound)) result[i] = start[i] + std::remainder(way, kTurn);
  }
  return result;
}

double objective(unsigned n, const double* x, double* gradient, void* data) {
  Problem& problem = *static_cast<Problem*>(data);
  const JointVector q =
      near_start(Eigen::Map<const JointVector>(x, static_cast<Eigen::Index>(n)), problem, kFar);
  JointVector slope = JointVector::Zero(q.size());
  if (!q.allFinite()) {
    if (gradient != nullptr) std::copy(slope.data(), slope.data() + slope.size(), gradient);
    return HUGE_VAL;
  }
  const double value = cost(q, problem, gradient == nullptr ? nullptr : &slope);
  if (gradient != nullptr) std::copy(slope.data(), slope.data() + slope.size(), gradient);
  if (value < problem.best_cost) {
    problem.best = q;
    problem.best_cost = value;
  }
  return value;
}

std::vector<double> as_vector(const JointVector& q) { return {q.data(), q.data() + q.size()}; }

}  // namespace

ErrorVector pose_error(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  ErrorVector error;
  error << to.translation() - from.translation(),
      prf_core::log_so3(Eigen::Quaterniond(to.linear() * from.linear().transpose()));
  return error;
}

JointVector nearest_pose(const ArmKinematics& arm, const Eigen::Isometry3d& hand_in_base,
                         const JointVector& start, double orientation_weight) {
  if (!hand_in_base.matrix().allFinite() || !start.allFinite()) {
    throw std::invalid_argument("nearest_pose: pose and start must be finite");
  }
  if (!(std::isfinite(orientation_weight) && orientation_weight > 0.0)) {
    throw std::invalid_argument("orientation_weight = " + std::to_string(orientation_weight) +
                                " m/rad, must be finite and > 0");
  }
  const auto& limits = arm.limits();
  Problem problem{arm, start, hand_in_base, {}, start, 0.0};
  problem.weight << 1.0, 1.0, 1.0, orientation_weight, orientation_weight, orientation_weight;
  problem.best = start.cwiseMax(limits.lower).cwiseMin(limits.upper);
  problem.best_cost = cost(problem.best, problem, nullptr);

  nlopt::opt search(nlopt::LD_SLSQP, static_cast<unsigned>(start.size()));
  search.set_min_objective(objective, &problem);
  search.set_lower_bounds(as_vector(limits.lower));
  search.set_upper_bounds(as_vector(limits.upper));
  search.set_xtol_abs(1e-10);
  search.set_ftol_abs(1e-14);
  search.set_maxeval(kMaxEvaluations);
  std::vector<double> q = as_vector(problem.best);
  double value = 0.0;
  try {
    search.optimize(q, value);
  } catch (const std::runtime_error&) {
    // SLSQP ends so at the limit of the arithmetic; the best position it has seen stands.
  }
  return near_start(problem.best, problem, M_PI);
}

}  // namespace prf_control
