// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/grid_texture.hpp"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <array>
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

struct Lattice {
  std::array<double, kSamples> dx{}, dy{};  // from the pixel's corner, px
};

constexpr Lattice make_lattice() {
  Lattice lattice;
  for (std::size_t i = 0; i < kSamples; ++i) {
    lattice.dx[i] = (static_cast<double>(i) + 0.5) / kSamples;
    lattice.dy[i] = (static_cast<double>(i * kLatticeStep % kSamples) + 0.5) / kSamples;
  }
  return lattice;
}

constexpr Lattice kLattice = make_lattice();

// Samples whose coordinate origin + a dx + b dy is at least `border`.
int count_beyond(double border, double origin, double a, double b) {
  int count = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    count += static_cast<int>(origin + (a * kLattice.dx[i] + b * kLattice.dy[i]) >= border);
  }
  return count;
}

// Samples that are beyond both borders.
int count_beyond(const Eigen::Vector2d& border, const Eigen::Vector2d& origin,
                 const Eigen::Matrix2d& d) {
  int count = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double dx = kLattice.dx[i], dy = kLattice.dy[i];
    const bool right = origin.x() + (d(0, 0) * dx + d(0, 1) * dy) >= border.x();
    const bool below = origin.y() + (d(1, 0) * dx + d(1, 1) * dy) >= border.y();
    count += static_cast<int>(right) & static_cast<int>(below);
  }
  return count;
}

unsigned char mean(int sum) { return static_cast<unsigned char>((sum + kSamples / 2) / kSamples); }

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
  if (u_last - u_first > 1 || v_last - v_first > 1) return mean_of_many(origin, derivative);
  // Two or four cells: how many samples fall into each.
  const auto beyond = [&](int axis, int first, int last) {
    return first == last
               ? 0
               : count_beyond(last, origin[axis], derivative(axis, 0), derivative(axis, 1));
  };
  const int right = beyond(0, u_first, u_last), below = beyond(1, v_first, v_last);
  const int both = right == 0 || below == 0
                       ? 0
                       : count_beyond(Eigen::Vector2d(u_last, v_last), origin, derivative);
  return mean((kSamples - right - below + both) * at(u_first, v_first) +
              (right - both) * at(u_last, v_first) + (below - both) * at(u_first, v_last) +
              both * at(u_last, v_last));
}

unsigned char GridTexture::mean_of_many(const Eigen::Vector2d& origin,
                                        const Eigen::Matrix2d& derivative) const {
  int sum = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d sample =
        origin + derivative * Eigen::Vector2d(kLattice.dx[i], kLattice.dy[i]);
    sum += at(index(sample.x(), columns_), index(sample.y(), rows_));
  }
  return mean(sum);
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
