// SPDX-License-Identifier: BSD-3-Clause
// A pinhole camera and one grey image taken by it.
//
// A point (X, Y, Z) of the optical frame (x right, y down, z forward) is seen at
//   u = fx X / Z + cx,  v = fy Y / Z + cy,
// in pixels with (0, 0) at the CENTRE of the first pixel, the convention of camera_info and OpenCV,
// unless the lens distorts (lens.hpp).
#pragma once

#include <array>
#include <cstdint>

namespace prf_perception {

// Bounds of an image's width and height, px. libapriltag crashes on images that are only a few of
// its 4 x 4 tiles, after decimation, large.
inline constexpr int kSmallestImage = 32;
inline constexpr int kLargestImage = 8192;

enum class LensModel {
  kBrown,        // camera_info's plumb_bob and rational_polynomial
  kEquidistant,  // camera_info's equidistant: a fisheye
};

struct CameraIntrinsics {
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  int width = 0;
  int height = 0;
  // Brown: k1, k2, p1, p2, k3, k4, k5, k6. Equidistant: k1, k2, k3, k4. The rest is zero.
  std::array<double, 8> distortion{};
  LensModel lens = LensModel::kBrown;

  // Whether the image differs from the ideal pinhole's; an equidistant lens always does.
  [[nodiscard]] bool distorts() const;

  // Throws std::invalid_argument with name, value and bound for what no camera has. Sizes are
  // 32 .. 8192 px, focal lengths 0.1 .. 100 times the image's size, the principal point is at most
  // 8192 px outside the image (which may be a window of a larger one), and the lens does not fold
  // the image over itself.
  void validate() const;
};

// 8 bit grey levels, row by row from the top. The view does not own them.
struct ImageView {
  const std::uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  int stride = 0;  // bytes from one row to the next, >= width
};

}  // namespace prf_perception
