// SPDX-License-Identifier: BSD-3-Clause
// Anti-aliased scan conversion of convex polygons.
// Pixel (i, j) covers [i, i+1) x [j, j+1). Coverage of a pixel is the mean over kSubRows horizontal
// lines of the exact length covered in it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace platform_sim {

using Polygon2d = std::vector<Eigen::Vector2d>;

inline constexpr int kSubRows = 8;

// Horizontal extent of a convex polygon on the line at height y; empty (begin > end) outside.
struct Extent {
  double begin = std::numeric_limits<double>::infinity();
  double end = -std::numeric_limits<double>::infinity();
};

inline Extent extent_at(const Polygon2d& polygon, double y) {
  Extent extent;
  for (std::size_t i = 0, previous = polygon.size() - 1; i < polygon.size(); previous = i++) {
    const Eigen::Vector2d& a = polygon[previous];
    const Eigen::Vector2d& b = polygon[i];
    if ((a.y() <= y) == (b.y() <= y)) continue;
    const double x = a.x() + (y - a.y()) * (b.x() - a.x()) / (b.y() - a.y());
    extent.begin = std::min(extent.begin, x);
    extent.end = std::max(extent.end, x);
  }
  return extent;
}

// Calls row(y, begin, end, coverage) for runs of pixels touched by the polygon; coverage is null
// where the pixels are covered wholly, else one value in 0..1 for each pixel of the run.
template <class Row>
void rasterize_convex(const Polygon2d& polygon, int width, int height, Row&& row) {
  if (polygon.size() < 3) return;
  double top = polygon[0].y(), bottom = polygon[0].y();
  for (const Eigen::Vector2d& point : polygon) {
    top = std::min(top, point.y());
    bottom = std::max(bottom, point.y());
  }
  const int y_begin = static_cast<int>(std::floor(std::clamp<double>(top, 0.0, height)));
  const int y_end = static_cast<int>(std::ceil(std::clamp<double>(bottom, 0.0, height)));
  std::vector<float> coverage(static_cast<std::size_t>(width));

  for (int y = y_begin; y < y_end; ++y) {
    std::array<Extent, kSubRows> extents;
    bool all_crossed = true;
    double outer_begin = width, outer_end = 0.0, inner_begin = 0.0, inner_end = width;
    for (int k = 0; k < kSubRows; ++k) {
      Extent extent = extent_at(polygon, y + (k + 0.5) / kSubRows);
      extent.begin = std::clamp<double>(extent.begin, 0.0, width);
      extent.end = std::clamp<double>(extent.end, 0.0, width);
      all_crossed = all_crossed && extent.begin < extent.end;
      if (extent.begin < extent.end) {
        outer_begin = std::min(outer_begin, extent.begin);
        outer_end = std::max(outer_end, extent.end);
        inner_begin = std::max(inner_begin, extent.begin);
        inner_end = std::min(inner_end, extent.end);
      }
      extents[static_cast<std::size_t>(k)] = extent;
    }
    const int begin = static_cast<int>(std::floor(outer_begin));
    const int end = static_cast<int>(std::ceil(outer_end));
    if (begin >= end) continue;
    int full_begin = end, full_end = end;
    if (all_crossed && std::ceil(inner_begin) < std::floor(inner_end)) {
      full_begin = static_cast<int>(std::ceil(inner_begin));
      full_end = static_cast<int>(std::floor(inner_end));
    }
    const auto partial = [&](int from, int to) {
      if (from >= to) return;
      for (int x = from; x < to; ++x) {
        double sum = 0.0;
        for (const Extent& extent : extents) {
          sum += std::max(0.0,
                          std::min<double>(extent.end, x + 1) - std::max<double>(extent.begin, x));
        }
        coverage[static_cast<std::size_t>(x)] = static_cast<float>(sum / kSubRows);
      }
      row(y, from, to, coverage.data() + from);
    };
    partial(begin, full_begin);
    if (full_begin < full_end) row(y, full_begin, full_end, static_cast<const float*>(nullptr));
    partial(full_end, end);
  }
}

}  // namespace platform_sim
