// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/square_pose.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <prf_core/require.hpp>
#include <prf_core/se3.hpp>
#include <string>
#include <utility>

namespace prf_perception {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Residual = Eigen::Matrix<double, 8, 1>;
using Jacobian = Eigen::Matrix<double, 8, 6>;

constexpr double kReferenceSide = 100.0;  // px, where corner_sigma holds
constexpr int kIterations = 50;
constexpr double kStepTolerance = 1e-12;
constexpr double kSameRotation = 1e-4;  // rad, two descents into one minimum

Eigen::Vector3d model_corner(std::size_t index, double side) {
  const double half = side / 2;
  return {index == 0 || index == 3 ? -half : half, index < 2 ? -half : half, 0.0};
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  return (Eigen::Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

Eigen::Vector2d project(const Eigen::Vector3d& point, const CameraIntrinsics& camera) {
  return {camera.fx * point.x() / point.z() + camera.cx,
          camera.fy * point.y() / point.z() + camera.cy};
}

// The marker is in front of the camera and shows its face.
bool is_visible(const Eigen::Isometry3d& pose, double side) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (!((pose * model_corner(i, side)).z() > 0)) return false;
  }
  return pose.linear().col(2).dot(pose.translation()) < 0;
}

Residual residual(const Corners& corners, const Eigen::Isometry3d& pose, double side,
                  const CameraIntrinsics& camera) {
  const Corners expected = project_corners(pose, side, camera);
  Residual e;
  for (std::size_t i = 0; i < 4; ++i) {
    e.segment<2>(2 * static_cast<int>(i)) = corners[i] - expected[i];
  }
  return e;
}

// d project(R m + t) / d (t, theta) with R -> Exp(theta) R.
Jacobian projection_jacobian(const Eigen::Isometry3d& pose, double side,
                             const CameraIntrinsics& camera) {
  Jacobian J;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d arm = pose.linear() * model_corner(i, side);
    const Eigen::Vector3d point = arm + pose.translation();
    const double inverse_depth = 1.0 / point.z();
    Eigen::Matrix<double, 2, 3> d_pixel;
    d_pixel << camera.fx * inverse_depth, 0, -camera.fx * point.x() * inverse_depth * inverse_depth,
        0, camera.fy * inverse_depth, -camera.fy * point.y() * inverse_depth * inverse_depth;
    const int row = 2 * static_cast<int>(i);
    J.block<2, 3>(row, 0) = d_pixel;
    J.block<2, 3>(row, 3) = -d_pixel * skew(arm);
  }
  return J;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Vector6d& step) {
  Eigen::Isometry3d result = pose;
  result.translation() += step.head<3>();
  result.linear() = (prf_core::exp_so3(step.tail<3>()) * Eigen::Quaterniond(pose.linear()))
                        .normalized()
                        .toRotationMatrix();
  return result;
}

struct Minimum {
  Eigen::Isometry3d pose;
  double squared_error;
};

// Levenberg-Marquardt from the guess into its minimum.
std::optional<Minimum> descend(const Corners& corners, const CameraIntrinsics& camera, double side,
                               const Eigen::Isometry3d& guess) {
  if (!guess.matrix().allFinite() || !is_visible(guess, side)) return std::nullopt;
  Minimum best{guess, residual(corners, guess, side, camera).squaredNorm()};
  double damping = 1e-6;
  for (int i = 0; i < kIterations; ++i) {
    const Jacobian J = projection_jacobian(best.pose, side, camera);
    Matrix6d normal = J.transpose() * J;
    normal.diagonal() *= 1.0 + damping;
    const Vector6d step =
        normal.ldlt().solve(J.transpose() * residual(corners, best.pose, side, camera));
    if (!step.allFinite()) return std::nullopt;
    if (step.norm() < kStepTolerance) break;
    const Eigen::Isometry3d candidate = moved(best.pose, step);
    const double error = is_visible(candidate, side)
                             ? residual(corners, candidate, side, camera).squaredNorm()
                             : std::numeric_limits<double>::infinity();
    if (error < best.squared_error) {
      best = {candidate, error};
      damping = std::max(damping * 0.1, 1e-12);
    } else {
      damping = std::max(damping * 10.0, 1e-6);
      if (damping > 1e6) break;
    }
  }
  return best;
}

// The marker reflected in depth: where the second minimum lies under weak perspective.
Eigen::Isometry3d mirrored(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d ray = pose.translation().normalized();
  const Eigen::Matrix3d reflection = Eigen::Matrix3d::Identity() - 2.0 * ray * ray.transpose();
  Eigen::Isometry3d result = pose;
  result.linear() = reflection * pose.linear() * Eigen::Vector3d(1, 1, -1).asDiagonal();
  return result;
}

double mean_side(const Corners& corners) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) sum += (corners[(i + 1) % 4] - corners[i]).norm();
  return sum / 4;
}

Eigen::Vector3d rotation_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  return prf_core::rotation_between(Eigen::Quaterniond(from.linear()),
                                    Eigen::Quaterniond(to.linear()));
}

Matrix6d covariance_of(const Minimum& found, const std::optional<Minimum>& other,
                       const Corners& corners, const CameraIntrinsics& camera, double side,
                       const CornerErrorModel& model) {
  // A side is a line fitted to as many pixels as it is long.
  const double variance =
      model.corner_sigma * model.corner_sigma * kReferenceSide / mean_side(corners);
  const Jacobian J = projection_jacobian(found.pose, side, camera);
  const Matrix6d normal = J.transpose() * J;
  Matrix6d P = variance * normal.ldlt().solve(Matrix6d::Identity());
  P.diagonal().head<3>().array() += model.position_floor * model.position_floor;
  P.diagonal().tail<3>().array() += model.orientation_floor * model.orientation_floor;

  if (other) {
    const double log_odds = 0.5 * (other->squared_error - found.squared_error) / variance;
    const double other_is_right = 1.0 / (1.0 + std::exp(log_odds));
    const Eigen::Vector3d apart = rotation_between(found.pose, other->pose);
    P.bottomRightCorner<3, 3>() += other_is_right * apart * apart.transpose();
  }
  return 0.5 * (P + P.transpose());
}

double root_mean_square(const Minimum& minimum) { return std::sqrt(minimum.squared_error / 4); }

}  // namespace

void CornerErrorModel::validate() const {
  prf_core::require_between("corner_sigma", corner_sigma, 1e-3, 10.0, "px");
  prf_core::require_between("position_floor", position_floor, 1e-7, 0.1, "m");
  prf_core::require_between("orientation_floor", orientation_floor, 1e-7, 1.0, "rad");
}

double SquarePose::ambiguity() const {
  if (!other_in_camera) return 0.0;
  return other_error > 0.0 ? reprojection_error / other_error : 1.0;
}

Corners project_corners(const Eigen::Isometry3d& marker_in_camera, double side,
                        const CameraIntrinsics& camera) {
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = project(marker_in_camera * model_corner(i, side), camera);
  }
  return corners;
}

std::optional<SquarePose> estimate_square_pose(const Corners& corners,
                                               const CameraIntrinsics& camera, double side,
                                               const Eigen::Isometry3d& guess,
                                               const CornerErrorModel& model) {
  for (const auto& corner : corners) {
    if (!corner.allFinite()) return std::nullopt;
  }
  auto found = descend(corners, camera, side, guess);
  if (!found) return std::nullopt;
  auto other = descend(corners, camera, side, mirrored(found->pose));
  if (other && rotation_between(found->pose, other->pose).norm() < kSameRotation) other.reset();
  if (other && other->squared_error < found->squared_error) std::swap(*found, *other);

  SquarePose result;
  result.marker_in_camera = found->pose;
  result.covariance = covariance_of(*found, other, corners, camera, side, model);
  result.reprojection_error = root_mean_square(*found);
  result.other_error = std::numeric_limits<double>::infinity();
  if (other) {
    result.other_error = root_mean_square(*other);
    result.other_in_camera = other->pose;
  }
  if (!result.covariance.allFinite()) return std::nullopt;
  return result;
}

}  // namespace prf_perception
