// SPDX-License-Identifier: BSD-3-Clause
// Lens distortion, as camera_info names the models. With the ideal pinhole's normalised coordinates
// (a, b) and r^2 = a^2 + b^2 the lens shows:
//
// plumb_bob (Brown 1966), and rational_polynomial, whose k4, k5, k6 plumb_bob has as zero:
//   a' = a R(r^2) + 2 p1 a b + p2 (r^2 + 2 a^2)
//   b' = b R(r^2) + p1 (r^2 + 2 b^2) + 2 p2 a b
//   R(s) = (1 + k1 s + k2 s^2 + k3 s^3) / (1 + k4 s + k5 s^2 + k6 s^3)
//
// equidistant (Kannala and Brandt 2006), also with all k zero no pinhole; theta = atan(r):
//   (a', b') = (a, b) / r  theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
#pragma once

#include <Eigen/Core>

#include "prf_perception/square_pose.hpp"

namespace prf_perception {

// Where a pixel of the ideal pinhole is seen through the lens. All functions here take and return
// pixels.
[[nodiscard]] Eigen::Vector2d distorted(const Eigen::Vector2d& ideal,
                                        const CameraIntrinsics& camera);

// The inverse, by Newton's method. May be not finite for a pixel that the model reaches from
// nowhere, and is not for one that an equidistant lens sees at 85 degrees or more from its axis.
[[nodiscard]] Eigen::Vector2d undistorted(const Eigen::Vector2d& seen,
                                          const CameraIntrinsics& camera);

// Corners of a marker for the ideal pinhole. libapriltag intersects straight lines, fitted to edges
// that the lens bends: the shift of each corner is computed from the bent edges and removed.
[[nodiscard]] Corners ideal_corners(const Corners& seen, const CameraIntrinsics& camera);

}  // namespace prf_perception
