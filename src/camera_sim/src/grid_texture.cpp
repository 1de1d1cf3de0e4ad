// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/grid_texture.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <cstdlib>
#include <utility>

namespace camera_sim {
namespace {

constexpr unsigned char kInk = 25;
constexpr unsigned char kPaper = 225;

// Fibonacci lattice: spread evenly over the pixel in every direction, so that an edge is placed to
// about 1/55 pixel whatever its slope.
constexpr int kSamples = 55;
constexpr int kLatticeStep = 34;

}  // namespace

GridTexture::GridTexture(int columns, std::vector<unsigned char> greys)
    : columns_(columns),
      rows_(static_cast<int>(greys.size()) / columns),
      greys_(std::move(greys)) {}

unsigned char GridTexture::mean_over_pixel(const Eigen::Vector2d& cell,
                                           const Eigen::Matrix2d& derivative) const {
  const Eigen::Vector2d half = 0.5 * derivative.cwiseAbs().rowwise().sum();
  const int u_first = index(cell.x() - half.x(), columns_);
  const int u_last = index(cell.x() + half.x(), columns_);
  const int v_first = index(cell.y() - half.y(), rows_);
  const int v_last = index(cell.y() + half.y(), rows_);
  const unsigned char grey = at(u_first, v_first);
  bool uniform = true;
  for (int v = v_first; v <= v_last; ++v) {
    for (int u = u_first; u <= u_last; ++u) uniform = uniform && at(u, v) == grey;
  }
  if (uniform) return grey;

  const Eigen::Vector2d origin = cell - derivative * Eigen::Vector2d(0.5, 0.5);
  int sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double dx = (i + 0.5) / kSamples;
    const double dy = (i * kLatticeStep % kSamples + 0.5) / kSamples;
    const Eigen::Vector2d sample = origin + derivative * Eigen::Vector2d(dx, dy);
    sum += at(index(sample.x(), columns_), index(sample.y(), rows_));
  }
  return static_cast<unsigned char>((sum + kSamples / 2) / kSamples);
}

GridTexture tag_texture() {
  apriltag_family_t* family = tag36h11_create();
  image_u8_t* bitmap = apriltag_to_image(family, 0);
  const int side = bitmap->width;
  std::vector<unsigned char> greys;
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      greys.push_back(bitmap->buf[v * bitmap->stride + u] > 127 ? kPaper : kInk);
    }
  }
  std::free(bitmap->buf);  // image_u8_destroy() is not exported by every build of libapriltag
  std::free(bitmap);
  tag36h11_destroy(family);
  return {side, std::move(greys)};
}

}  // namespace camera_sim
