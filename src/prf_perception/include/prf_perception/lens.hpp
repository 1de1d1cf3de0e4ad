// SPDX-License-Identifier: BSD-3-Clause
// Lens distortion: camera_info's model plumb_bob (Brown 1966). With the ideal pinhole's normalised
// coordinates (a, b) and r^2 = a^2 + b^2 the lens shows
//   a' = a (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 a b + p2 (r^2 + 2 a^2)
//   b' = b (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 b^2) + 2 p2 a b.
#pragma once

#include <Eigen/Core>

#include "prf_perception/square_pose.hpp"

namespace prf_perception {

// Where a pixel of the ideal pinhole is seen through the lens. All functions here take and return
// pixels.
[[nodiscard]] Eigen::Vector2d distorted(const Eigen::Vector2d& ideal,
                                        const CameraIntrinsics& camera);

// The inverse, by Newton's method. May be not finite for a pixel that the model reaches from
// nowhere.
[[nodiscard]] Eigen::Vector2d undistorted(const Eigen::Vector2d& seen,
                                          const CameraIntrinsics& camera);

// Corners of a marker for the ideal pinhole. libapriltag intersects straight lines, fitted to edges
// that the lens bends: the shift of each corner is computed from the bent edges and removed.
[[nodiscard]] Corners ideal_corners(const Corners& seen, const CameraIntrinsics& camera);

}  // namespace prf_perception
