// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace camera_sim {

/// Pinhole with the lens distortion of camera_info's model plumb_bob (Brown 1966). A point (x, y,
/// z) of the optical frame (x right, y down, z forward) has the normalised coordinates (a, b) =
/// (x/z, y/z), r^2 = a^2 + b^2, which the lens moves to
///   a' = a (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 a b + p2 (r^2 + 2 a^2)
///   b' = b (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 b^2) + 2 p2 a b;
/// it is seen at pixel (fx a' + cx, fy b' + cy), where (0, 0) is the centre of the first pixel.
struct PinholeCamera {
  int width = 640;
  int height = 480;
  double fx = 615.0;
  double fy = 615.0;
  double cx = 320.0;
  double cy = 240.0;
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3

  /// Throws std::invalid_argument with name, value and bound; also for a distortion whose
  /// radial part does not rise up to the image's corners: it would fold the image over itself.
  void validate() const;

  [[nodiscard]] bool distorts() const;
  /// What the lens does to normalised coordinates.
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& normalised) const;
  /// d distort / d normalised.
  [[nodiscard]] Eigen::Matrix2d distortion_jacobian(const Eigen::Vector2d& normalised) const;
  /// Pixel of normalised coordinates.
  [[nodiscard]] Eigen::Vector2d to_pixel(const Eigen::Vector2d& normalised) const;
  /// Inverse of to_pixel(), for pixels in or near the image. Farther out the result means nothing
  /// when the lens distorts.
  [[nodiscard]] Eigen::Vector2d to_normalised(const Eigen::Vector2d& pixel) const;
};

}  // namespace camera_sim
