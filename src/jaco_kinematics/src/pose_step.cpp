// SPDX-License-Identifier: BSD-3-Clause
#include "pose_step.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <optional>

namespace jaco_kinematics {

namespace {

// Joints 5 to 7 turn the hand about the wrist centre W and leave W in place, so J falls apart:
//   W's motion   = A x,        x of joints 1 to 4
//   hand's turn  = C x + B y,  y of joints 5 to 7
// Nothing near a singularity of A or B.
std::optional<PoseStep> decoupled_step(const Frames& frames,
                                       const Eigen::Matrix<double, 6, 1>& difference) {
  constexpr double kLeastVolume = 1e-3;  // of A, [m^3]; it is 0.05 in the middle of the workspace
  constexpr double kLeastSine = 1e-2;    // of q6
  const Eigen::Vector3d wrist = frames.origin[5];
  Eigen::Matrix<double, 3, 4> a;
  Eigen::Matrix<double, 3, 4> c;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    c.col(column) = frames.rotation[i].col(2);
    a.col(column) = c.col(column).cross(wrist - frames.origin[i]);
  }
  // Null vector of A by its minors; the sum of their squares is det(A A^T).
  const Eigen::Vector3d last = a.col(2).cross(a.col(3));
  const Eigen::Vector3d first = a.col(0).cross(a.col(1));
  Eigen::Vector4d null;
  null << a.col(1).dot(last), -a.col(0).dot(last), first.dot(a.col(3)), -first.dot(a.col(2));
  const bool regular = null.squaredNorm() >= kLeastVolume * kLeastVolume;
  if (!regular) return std::nullopt;
  // The inverse of B = [a5 a6 a7] by Cramer's rule.
  const Eigen::Vector3d a5 = frames.rotation[4].col(2);
  const Eigen::Vector3d a6 = frames.rotation[5].col(2);
  const Eigen::Vector3d a7 = frames.rotation[6].col(2);
  const double determinant = a5.dot(a6.cross(a7));
  if (std::abs(determinant) < kLeastSine) return std::nullopt;
  Eigen::Matrix3d b_inverse;
  b_inverse.row(0) = a6.cross(a7) / determinant;
  b_inverse.row(1) = a7.cross(a5) / determinant;
  b_inverse.row(2) = a5.cross(a6) / determinant;

  const Eigen::Vector3d turn = difference.tail<3>();
  const Eigen::Vector3d wrist_motion =
      difference.head<3>() + turn.cross(wrist - frames.end_effector.translation());
  PoseStep step;
  step.self_motion << null, -b_inverse * (c * null);
  step.self_motion.normalize();
  const Eigen::Vector4d x = a.transpose() * ((a * a.transpose()).inverse() * wrist_motion);
  step.least << x, b_inverse * (turn - c * x);
  step.least -= step.self_motion.dot(step.least) * step.self_motion;
  return step;
}

// Slightly damped, so that singularities do no harm.
PoseStep damped_step(const Frames& frames, const Eigen::Matrix<double, 6, 1>& difference) {
  constexpr double kDamping = 1e-10;  // [m^2], [rad^2]
  using Projector = Eigen::Matrix<double, 7, 7>;
  const Jacobian j = jacobian(frames);
  Eigen::Matrix<double, 6, 6> gram = j * j.transpose();
  gram.diagonal().array() += kDamping;
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> solver(gram);
  const Projector projector = Projector::Identity() - j.transpose() * solver.solve(j);
  Eigen::Index largest = 0;
  projector.diagonal().maxCoeff(&largest);
  return {j.transpose() * solver.solve(difference), projector.col(largest).normalized()};
}

}  // namespace

PoseStep pose_step(const Frames& frames, const Eigen::Matrix<double, 6, 1>& difference) {
  const auto step = decoupled_step(frames, difference);
  return step ? *step : damped_step(frames, difference);
}

}  // namespace jaco_kinematics
