// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/pinhole_camera.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <string>

namespace camera_sim {
namespace {

constexpr double kLeastSlope = 0.2;  // of the radial distortion within the image
// Of the coefficients: lenses in use stay below a tenth of these.
constexpr double kLargestTangential = 0.1;
constexpr double kLargestRadial = 10.0;
constexpr int kLargestImage = 4096;  // px
// Focal length over the larger side: from a view of 157 degrees to one of 0.6 degrees.
constexpr double kShortest = 0.1;
constexpr double kLongest = 100.0;
constexpr double kMargin = 1.1;  // of the image's corners
constexpr int kNewtonSteps = 12;
constexpr double kConverged = 1e-16;  // squared; one more step squares the error

// Distance of the image's farthest corner from the optical axis in distorted coordinates.
double farthest_corner(const PinholeCamera& camera) {
  const double x = std::max(std::abs(camera.cx), std::abs(camera.width - camera.cx)) / camera.fx;
  const double y = std::max(std::abs(camera.cy), std::abs(camera.height - camera.cy)) / camera.fy;
  return std::hypot(x, y);
}

// The radial part must rise until it has passed the corners.
bool reaches_the_corners(const PinholeCamera& camera) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double corner = kMargin * farthest_corner(camera);
  constexpr double kStep = 0.01;
  for (double r = 0.0, seen = 0.0; seen < corner; r += kStep) {
    const double s = r * r;
    seen = r * (1.0 + s * (k1 + s * (k2 + s * k3)));
    if (!(1.0 + s * (3.0 * k1 + s * (5.0 * k2 + s * 7.0 * k3)) > kLeastSlope)) return false;
  }
  return true;
}

}  // namespace

void PinholeCamera::validate() const {
  prf_core::require_between("width", width, 1, kLargestImage, "px");
  prf_core::require_between("height", height, 1, kLargestImage, "px");
  const double side = std::max(width, height);
  prf_core::require_between("fx", fx, kShortest * side, kLongest * side, "px");
  prf_core::require_between("fy", fy, kShortest * side, kLongest * side, "px");
  prf_core::require_between("cx", cx, -1.0 * width, 2.0 * width, "px");
  prf_core::require_between("cy", cy, -1.0 * height, 2.0 * height, "px");
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    const double largest = i == 2 || i == 3 ? kLargestTangential : kLargestRadial;
    prf_core::require_between("distortion[" + std::to_string(i) + "]", distortion[i], -largest,
                              largest);
  }
  if (distorts()) {
    prf_core::require(reaches_the_corners(*this), "distortion[0]", distortion[0],
                      "so that the radial distortion rises up to the image's corners");
  }
}

bool PinholeCamera::distorts() const {
  return std::any_of(distortion.begin(), distortion.end(), [](double d) { return d != 0.0; });
}

Eigen::Vector2d PinholeCamera::distort(const Eigen::Vector2d& normalised) const {
  const auto& [k1, k2, p1, p2, k3] = distortion;
  const double a = normalised.x(), b = normalised.y(), s = normalised.squaredNorm();
  const double radial = 1.0 + s * (k1 + s * (k2 + s * k3));
  return {a * radial + 2.0 * p1 * a * b + p2 * (s + 2.0 * a * a),
          b * radial + p1 * (s + 2.0 * b * b) + 2.0 * p2 * a * b};
}

Eigen::Matrix2d PinholeCamera::distortion_jacobian(const Eigen::Vector2d& normalised) const {
  const auto& [k1, k2, p1, p2, k3] = distortion;
  const double a = normalised.x(), b = normalised.y(), s = normalised.squaredNorm();
  const double radial = 1.0 + s * (k1 + s * (k2 + s * k3));
  const double slope = 2.0 * (k1 + s * (2.0 * k2 + s * 3.0 * k3));  // of radial, per a and per b
  const double mixed = a * b * slope + 2.0 * p1 * a + 2.0 * p2 * b;
  Eigen::Matrix2d J;
  J << radial + a * a * slope + 2.0 * p1 * b + 6.0 * p2 * a, mixed,  //
      mixed, radial + b * b * slope + 6.0 * p1 * b + 2.0 * p2 * a;
  return J;
}

Eigen::Vector2d PinholeCamera::to_pixel(const Eigen::Vector2d& normalised) const {
  const Eigen::Vector2d seen = distorts() ? distort(normalised) : normalised;
  return {fx * seen.x() + cx, fy * seen.y() + cy};
}

Eigen::Vector2d PinholeCamera::to_normalised(const Eigen::Vector2d& pixel) const {
  Eigen::Vector2d seen((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  if (!distorts()) return seen;
  Eigen::Vector2d normalised = seen;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Eigen::Vector2d error = distort(normalised) - seen;
    normalised -= distortion_jacobian(normalised).inverse() * error;
    if (error.squaredNorm() < kConverged) break;
  }
  return normalised;
}

}  // namespace camera_sim
