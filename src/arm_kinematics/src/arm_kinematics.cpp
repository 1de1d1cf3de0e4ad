// SPDX-License-Identifier: BSD-3-Clause
#include "arm_kinematics/arm_kinematics.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <prf_core/bounds.hpp>
#include <prf_core/require.hpp>
#include <string>

#include "bounded_step.hpp"
#include "task_error.hpp"

namespace arm_kinematics {
namespace {

constexpr int kMaxIterations = 200;
constexpr double kSmallestStep = 1e-11;  // rad, m
constexpr double kLargestStep = 0.5;     // rad, m
// Levenberg-Marquardt, Marquardt's factors; of squared metres.
constexpr double kFirstDamping = 1e-3;
constexpr double kRaise = 10.0;
constexpr double kLower = 0.1;
constexpr double kLargestDamping = 1e6;
// [m^2] Singular directions of J J^T below it count as none.
constexpr double kSingular = 1e-9;

// What the bending of the tip's path adds to the second derivatives of |p(q) - p|^2 / 2:
// d2p / dq_i dq_k = a_i x J_k for the axis a_i of a joint i not behind k. Far from a pose out of
// reach it is what counts, and without it the search creeps.
JointMatrix curvature(const Jacobian& jacobian, const Eigen::Vector3d& e) {
  const Eigen::Index n = jacobian.cols();
  JointMatrix h(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d axis = jacobian.col(i).tail<3>();
    for (Eigen::Index k = i; k < n; ++k) {
      h(i, k) = h(k, i) = -e.dot(axis.cross(jacobian.col(k).head<3>()));
    }
  }
  return h;
}

}  // namespace

void ArmKinematics::require_joints(const JointVector& q, const char* name) const {
  prf_core::require(q.size() == joint_count(), std::string(name) + "'s size", q.size(),
                    std::to_string(joint_count()));
  prf_core::require_within(name, q, prf_core::kMaxJointPosition, "rad or m");
}

JointVector ArmKinematics::nearest(const Eigen::Isometry3d& pose, const JointVector& start,
                                   double orientation_weight) const {
  prf_core::require_within("pose", pose.matrix(), prf_core::kMaxPosition, "m");
  require_joints(start, "start");
  prf_core::require_positive_up_to("orientation_weight", orientation_weight, 1e3, "m/rad");
  Twist weight;
  weight << 1.0, 1.0, 1.0, Eigen::Vector3d::Constant(orientation_weight);

  const JointLimits& bounds = limits();
  JointVector q = start.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  Placement now = placement(q);
  TaskError error = task_error(now, pose, task());
  double cost = error.value.cwiseProduct(weight).squaredNorm();
  double damping = kFirstDamping;
  for (int i = 0; i < kMaxIterations && damping < kLargestDamping; ++i) {
    const Jacobian a = weight.asDiagonal() * error.jacobian;
    JointMatrix h = a.transpose() * a + curvature(now.jacobian, error.value.head<3>());
    h.diagonal().array() += damping;
    const JointVector g = a.transpose() * error.value.cwiseProduct(weight);
    const JointVector room = JointVector::Constant(q.size(), kLargestStep);
    const auto step =
        bounded_step(h, g, (bounds.lower - q).cwiseMax(-room), (bounds.upper - q).cwiseMin(room));
    if (!step) {
      damping *= kRaise;
      continue;
    }
    if (step->cwiseAbs().maxCoeff() <= kSmallestStep) break;
    const JointVector next = (q + *step).cwiseMax(bounds.lower).cwiseMin(bounds.upper);
    const Placement there = placement(next);
    const TaskError next_error = task_error(there, pose, task());
    const double next_cost = next_error.value.cwiseProduct(weight).squaredNorm();
    if (!(next_cost < cost)) {
      damping *= kRaise;
      continue;
    }
    q = next;
    now = there;
    error = next_error;
    cost = next_cost;
    damping *= kLower;
  }
  return q;
}

JointVector ArmKinematics::self_motion(const JointVector& q, const JointVector& wanted) const {
  require_joints(wanted, "wanted");
  const Placement placed = placement(q);
  const Jacobian j = task_error(placed, placed.tip, task()).jacobian;
  if (joint_count() <= (task() == Task::kPose ? 6 : 5)) return JointVector::Zero(q.size());
  Eigen::Matrix<double, 6, 6> normal = j * j.transpose();
  normal.diagonal().array() += kSingular;
  return wanted - j.transpose() * normal.ldlt().solve(j * wanted);
}

JointVector ArmKinematics::middle() const {
  const JointLimits& bounds = limits();
  JointVector result = JointVector::Zero(bounds.lower.size());
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (std::isfinite(bounds.lower[i])) result[i] = 0.5 * (bounds.lower[i] + bounds.upper[i]);
  }
  return result;
}

bool ArmKinematics::reaches(const Eigen::Isometry3d& pose) const {
  return inverse(pose, middle()).solved;
}

JointVector ArmKinematics::posture_motion(const JointVector& q) const {
  require_joints(q, "q");
  const JointLimits& bounds = limits();
  // Each at most 1: with 1 / sqrt(joints) the norm is, too, and a projection does not lengthen it.
  JointVector wanted = JointVector::Zero(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (!std::isfinite(bounds.lower[i])) continue;
    const double half = 0.5 * (bounds.upper[i] - bounds.lower[i]);
    wanted[i] = std::clamp((middle()[i] - q[i]) / half, -1.0, 1.0);
  }
  return self_motion(q, wanted / std::sqrt(static_cast<double>(q.size())));
}

}  // namespace arm_kinematics
