// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/lens.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lens_polynomials.hpp"

namespace prf_perception {
namespace {

constexpr int kNewtonSteps = 10;
constexpr int kEdgeSamples = 16;  // of libapriltag, along an edge
constexpr int kRounds = 2;        // the shift depends on where the corners are, but little

using Line = Eigen::Hyperplane<double, 2>;

Eigen::Vector2d brown(const Eigen::Vector2d& point, const CameraIntrinsics& camera) {
  const double p1 = camera.distortion[2], p2 = camera.distortion[3];
  const double a = point.x(), b = point.y(), s = point.squaredNorm();
  const double radial = brown_radial(camera, s).value;
  return {a * radial + 2.0 * p1 * a * b + p2 * (s + 2.0 * a * a),
          b * radial + p1 * (s + 2.0 * b * b) + 2.0 * p2 * a * b};
}

Eigen::Matrix2d brown_jacobian(const Eigen::Vector2d& point, const CameraIntrinsics& camera) {
  const double p1 = camera.distortion[2], p2 = camera.distortion[3];
  const double a = point.x(), b = point.y();
  const auto [radial, radial_slope] = brown_radial(camera, point.squaredNorm());
  const double slope = 2.0 * radial_slope;
  const double mixed = a * b * slope + 2.0 * p1 * a + 2.0 * p2 * b;
  Eigen::Matrix2d J;
  J << radial + a * a * slope + 2.0 * p1 * b + 6.0 * p2 * a, mixed,  //
      mixed, radial + b * b * slope + 6.0 * p1 * b + 2.0 * p2 * a;
  return J;
}

Eigen::Vector2d brown_inverse(const Eigen::Vector2d& seen, const CameraIntrinsics& camera) {
  Eigen::Vector2d point = seen;
  for (int i = 0; i < kNewtonSteps; ++i) {
    point -= brown_jacobian(point, camera).inverse() * (brown(point, camera) - seen);
  }
  return point;
}

Eigen::Vector2d equidistant(const Eigen::Vector2d& point, const CameraIntrinsics& camera) {
  const double r = point.norm();
  if (r == 0.0) return point;
  return point * (equidistant_radius(camera, std::atan(r)).value / r);
}

Eigen::Vector2d equidistant_inverse(const Eigen::Vector2d& seen, const CameraIntrinsics& camera) {
  const double radius = seen.norm();
  if (radius == 0.0) return seen;
  double theta = std::min(radius, kWidestAngle);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const auto [value, slope] = equidistant_radius(camera, theta);
    theta = std::clamp(theta - (value - radius) / slope, 0.0, kWidestAngle);
  }
  if (!(theta < kWidestAngle)) {
    return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  return seen * (std::tan(theta) / radius);
}

Eigen::Vector2d normalised(const Eigen::Vector2d& pixel, const CameraIntrinsics& camera) {
  return {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy};
}

Eigen::Vector2d to_pixel(const Eigen::Vector2d& point, const CameraIntrinsics& camera) {
  return {camera.fx * point.x() + camera.cx, camera.fy * point.y() + camera.cy};
}

// The line through the image of a straight edge, by total least squares.
Line line_along_edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                     const CameraIntrinsics& camera) {
  Eigen::Matrix<double, 2, kEdgeSamples> points;
  for (int i = 0; i < kEdgeSamples; ++i) {
    points.col(i) = distorted(from + (i + 1.0) / (kEdgeSamples + 1.0) * (to - from), camera);
  }
  const Eigen::Vector2d mean = points.rowwise().mean();
  points.colwise() -= mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(points * points.transpose());
  return {axes.eigenvectors().col(0), mean};
}

}  // namespace

Eigen::Vector2d distorted(const Eigen::Vector2d& ideal, const CameraIntrinsics& camera) {
  const bool is_brown = camera.lens == LensModel::kBrown;
  const Eigen::Vector2d point = normalised(ideal, camera);
  return to_pixel(is_brown ? brown(point, camera) : equidistant(point, camera), camera);
}

Eigen::Vector2d undistorted(const Eigen::Vector2d& seen, const CameraIntrinsics& camera) {
  const bool is_brown = camera.lens == LensModel::kBrown;
  const Eigen::Vector2d point = normalised(seen, camera);
  return to_pixel(is_brown ? brown_inverse(point, camera) : equidistant_inverse(point, camera),
                  camera);
}

Corners ideal_corners(const Corners& seen, const CameraIntrinsics& camera) {
  if (!camera.distorts()) return seen;
  Corners ideal;
  for (std::size_t i = 0; i < 4; ++i) ideal[i] = undistorted(seen[i], camera);
  for (int round = 0; round < kRounds; ++round) {
    std::array<Line, 4> edges;
    for (std::size_t i = 0; i < 4; ++i) {
      edges[i] = line_along_edge(ideal[i], ideal[(i + 1) % 4], camera);
    }
    Corners better;
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d fitted = edges[i].intersection(edges[(i + 3) % 4]);
      better[i] = undistorted(seen[i] - (fitted - distorted(ideal[i], camera)), camera);
    }
    ideal = better;
  }
  return ideal;
}

}  // namespace prf_perception
