// SPDX-License-Identifier: BSD-3-Clause
#include "tag_texture.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <cstdlib>

namespace platform_sim {
namespace {

constexpr unsigned char kInk = 25;
constexpr unsigned char kPaper = 225;

// Fibonacci lattice: spread evenly over the pixel in every direction, so that an edge is placed to
// about 1/55 pixel whatever its slope.
constexpr int kSamples = 55;
constexpr int kLatticeStep = 34;

}  // namespace

TagTexture::TagTexture() {
  apriltag_family_t* family = tag36h11_create();
  image_u8_t* bitmap = apriltag_to_image(family, 0);
  side_ = bitmap->width;
  for (int v = 0; v < side_; ++v) {
    for (int u = 0; u < side_; ++u) {
      greys_.push_back(bitmap->buf[v * bitmap->stride + u] > 127 ? kPaper : kInk);
    }
  }
  std::free(bitmap->buf);  // image_u8_destroy() is not exported by every build of libapriltag
  std::free(bitmap);
  tag36h11_destroy(family);
}

unsigned char TagTexture::mean_over_pixel(const Eigen::Matrix3d& to_modules, double x,
                                          double y) const {
  // The map is projective; within a pixel its derivative at the centre stands for it.
  const Eigen::Vector3d centre = to_modules * Eigen::Vector3d(x + 0.5, y + 0.5, 1.0);
  const Eigen::Vector2d module = centre.hnormalized();
  const Eigen::Matrix2d derivative =
      (to_modules.topLeftCorner<2, 2>() - module * to_modules.bottomLeftCorner<1, 2>()) /
      centre.z();

  const Eigen::Vector2d half = 0.5 * derivative.cwiseAbs().rowwise().sum();
  const int u_first = index(module.x() - half.x()), u_last = index(module.x() + half.x());
  const int v_first = index(module.y() - half.y()), v_last = index(module.y() + half.y());
  const unsigned char grey = at(u_first, v_first);
  bool uniform = true;
  for (int v = v_first; v <= v_last; ++v) {
    for (int u = u_first; u <= u_last; ++u) uniform = uniform && at(u, v) == grey;
  }
  if (uniform) return grey;

  const Eigen::Vector2d origin = module - derivative * Eigen::Vector2d(0.5, 0.5);
  int sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double dx = (i + 0.5) / kSamples;
    const double dy = (i * kLatticeStep % kSamples + 0.5) / kSamples;
    const Eigen::Vector2d sample = origin + derivative * Eigen::Vector2d(dx, dy);
    sum += at(index(sample.x()), index(sample.y()));
  }
  return static_cast<unsigned char>((sum + kSamples / 2) / kSamples);
}

}  // namespace platform_sim
