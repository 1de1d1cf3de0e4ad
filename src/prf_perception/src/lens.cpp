// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/lens.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace prf_perception {
namespace {

constexpr int kNewtonSteps = 10;
constexpr int kEdgeSamples = 16;  // of libapriltag, along an edge
constexpr int kRounds = 2;        // the shift depends on where the corners are, but little

using Line = Eigen::Hyperplane<double, 2>;

Eigen::Vector2d distort_normalised(const Eigen::Vector2d& point, const CameraIntrinsics& camera) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double a = point.x(), b = point.y(), s = point.squaredNorm();
  const double radial = 1.0 + s * (k1 + s * (k2 + s * k3));
  return {a * radial + 2.0 * p1 * a * b + p2 * (s + 2.0 * a * a),
          b * radial + p1 * (s + 2.0 * b * b) + 2.0 * p2 * a * b};
}

Eigen::Matrix2d jacobian(const Eigen::Vector2d& point, const CameraIntrinsics& camera) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double a = point.x(), b = point.y(), s = point.squaredNorm();
  const double radial = 1.0 + s * (k1 + s * (k2 + s * k3));
  const double slope = 2.0 * (k1 + s * (2.0 * k2 + s * 3.0 * k3));
  const double mixed = a * b * slope + 2.0 * p1 * a + 2.0 * p2 * b;
  Eigen::Matrix2d J;
  J << radial + a * a * slope + 2.0 * p1 * b + 6.0 * p2 * a, mixed,  //
      mixed, radial + b * b * slope + 6.0 * p1 * b + 2.0 * p2 * a;
  return J;
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
  return to_pixel(distort_normalised(normalised(ideal, camera), camera), camera);
}

Eigen::Vector2d undistorted(const Eigen::Vector2d& seen, const CameraIntrinsics& camera) {
  const Eigen::Vector2d target = normalised(seen, camera);
  Eigen::Vector2d point = target;
  for (int i = 0; i < kNewtonSteps; ++i) {
    point -= jacobian(point, camera).inverse() * (distort_normalised(point, camera) - target);
  }
  return to_pixel(point, camera);
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
