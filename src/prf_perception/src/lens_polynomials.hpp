// SPDX-License-Identifier: BSD-3-Clause
// The polynomials of the lens models of lens.hpp, with their derivatives.
#pragma once

#include <cmath>

#include "prf_perception/camera.hpp"

namespace prf_perception {

// Where the pinhole, to which an equidistant lens is corrected, ends: 85 degrees from the axis.
inline constexpr double kWidestAngle = 85.0 / 180.0 * 3.14159265358979323846;

struct ValueAndSlope {
  double value;
  double slope;
};

// R(s) of the Brown model, and dR/ds.
inline ValueAndSlope brown_radial(const CameraIntrinsics& camera, double s) {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = camera.distortion;
  const double above = 1.0 + s * (k1 + s * (k2 + s * k3));
  const double below = 1.0 + s * (k4 + s * (k5 + s * k6));
  const double above_slope = k1 + s * (2.0 * k2 + s * 3.0 * k3);
  const double below_slope = k4 + s * (2.0 * k5 + s * 3.0 * k6);
  const double value = above / below;
  return {value, (above_slope - value * below_slope) / below};
}

// Distance from the centre at which the equidistant model shows the angle theta, rad, and its
// derivative.
inline ValueAndSlope equidistant_radius(const CameraIntrinsics& camera, double theta) {
  const auto& k = camera.distortion;
  const double s = theta * theta;
  return {theta * (1.0 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3])))),
          1.0 + s * (3.0 * k[0] + s * (5.0 * k[1] + s * (7.0 * k[2] + s * 9.0 * k[3])))};
}

}  // namespace prf_perception
