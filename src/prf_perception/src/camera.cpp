// SPDX-License-Identifier: BSD-3-Clause
#include "prf_perception/camera.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <sstream>
#include <string>

#include "lens_polynomials.hpp"

namespace prf_perception {
namespace {

// Focal length over width or height: from a view of 157 degrees to one of 0.6 degrees.
constexpr double kShortest = 0.1;
constexpr double kLongest = 100.0;
constexpr double kPixelAspect = 2.0;  // fx / fy at most, and at least its inverse
// Of what is seen over the ideal radius; 1 at the centre.
constexpr double kLeastSlope = 0.2;
constexpr double kLargestSlope = 5.0;
constexpr double kMargin = 1.1;  // of the image's corners
constexpr int kRadii = 200;

void require_focal_length(const std::string& name, double value, double size) {
  prf_core::require_between(name, value, kShortest * size, kLongest * size, "px");
}

// The image may be a window that was cut out of the largest one, anywhere.
void require_principal_point(const std::string& name, double value) {
  prf_core::require_between(name, value, -kLargestImage, 2.0 * kLargestImage, "px");
}

// Normalised distance of the image's farthest corner from the optical axis, as it is seen.
double farthest_corner(const CameraIntrinsics& camera) {
  const double x = std::max(std::abs(camera.cx), std::abs(camera.width - camera.cx)) / camera.fx;
  const double y = std::max(std::abs(camera.cy), std::abs(camera.height - camera.cy)) / camera.fy;
  return std::hypot(x, y);
}

// What is seen must move outward with the ideal radius r, neither too slowly nor too fast, until it
// has passed the corners: a lens that folds the image over itself has no inverse there, and so no
// pose. The derivatives of the tangential part are at most 6 (|p1| + |p2|) r. Not-a-number fails.
bool brown_rises_to_the_corners(const CameraIntrinsics& camera) {
  const double tangential = 6.0 * (std::abs(camera.distortion[2]) + std::abs(camera.distortion[3]));
  const double corner = kMargin * farthest_corner(camera);
  const double step = corner / kRadii;
  double seen = 0.0;
  // With the least slope the corner is reached at this radius at the latest.
  for (double r = 0.0; seen < corner && r <= corner / kLeastSlope + step; r += step) {
    const auto [radial, radial_slope] = brown_radial(camera, r * r);
    seen = r * radial;
    const double slope = radial + 2.0 * r * r * radial_slope;
    const double bend = tangential * r;
    if (!(slope - bend > kLeastSlope && slope + bend < kLargestSlope)) return false;
  }
  return seen >= corner;
}

// The same over the angle, up to the corners or, of a lens that sees farther, to the widest angle.
bool equidistant_rises(const CameraIntrinsics& camera) {
  const double corner = kMargin * farthest_corner(camera);
  double seen = 0.0;
  for (int i = 0; seen < corner && i <= kRadii; ++i) {
    const auto [radius, slope] = equidistant_radius(camera, kWidestAngle * i / kRadii);
    seen = radius;
    if (!(slope > kLeastSlope && slope < kLargestSlope)) return false;
  }
  return true;
}

}  // namespace

bool CameraIntrinsics::distorts() const {
  return lens == LensModel::kEquidistant ||
         std::any_of(distortion.begin(), distortion.end(), [](double d) { return d != 0.0; });
}

void CameraIntrinsics::validate() const {
  prf_core::require_between("camera width", width, kSmallestImage, kLargestImage, "px");
  prf_core::require_between("camera height", height, kSmallestImage, kLargestImage, "px");
  require_focal_length("camera fx", fx, std::max(width, height));
  require_focal_length("camera fy", fy, std::max(width, height));
  prf_core::require_between("camera fx / fy", fx / fy, 1.0 / kPixelAspect, kPixelAspect);
  require_principal_point("camera cx", cx);
  require_principal_point("camera cy", cy);
  if (!distorts()) return;
  std::ostringstream coefficients;
  for (const double d : distortion) coefficients << d << " ";
  const bool is_brown = lens == LensModel::kBrown;
  prf_core::require(
      is_brown ? brown_rises_to_the_corners(*this) : equidistant_rises(*this),
      std::string("camera distortion ") + (is_brown ? "k1 k2 p1 p2 k3 k4 k5 k6" : "k1 k2 k3 k4"),
      coefficients.str(),
      "such that what is seen moves outward with the radius, up to the corners");
}

}  // namespace prf_perception
