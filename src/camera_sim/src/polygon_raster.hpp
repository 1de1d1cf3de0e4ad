// SPDX-License-Identifier: BSD-3-Clause
// Anti-aliased scan conversion of polygons, by the even-odd rule.
// Pixel (i, j) covers [i, i+1) x [j, j+1). Coverage of a pixel is the mean over kSubRows horizontal
// lines of the exact length covered in it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace camera_sim {

using Polygon2d = std::vector<Eigen::Vector2d>;

class PolygonRaster {
 public:
  PolygonRaster(int width, int height)
      : width_(width),
        height_(height),
        lines_(static_cast<std::size_t>(height * kSubRows)),
        sums_(static_cast<std::size_t>(width)),
        coverage_(static_cast<std::size_t>(width)) {}

  // Calls row(y, begin, end, coverage) for runs of pixels touched by the polygon; coverage is null
  // where the pixels are covered wholly, else one value in 0..1 for each pixel of the run.
  template <class Row>
  void fill(const Polygon2d& polygon, Row&& row) {
    if (polygon.size() < 3) return;
    double top = polygon[0].y(), bottom = polygon[0].y();
    for (const Eigen::Vector2d& point : polygon) {
      top = std::min(top, point.y());
      bottom = std::max(bottom, point.y());
    }
    const int y_begin = static_cast<int>(std::floor(std::clamp<double>(top, 0.0, height_)));
    const int y_end = static_cast<int>(std::ceil(std::clamp<double>(bottom, 0.0, height_)));
    for (int i = y_begin * kSubRows; i < y_end * kSubRows; ++i) line(i).count = 0;
    for (std::size_t i = 0, previous = polygon.size() - 1; i < polygon.size(); previous = i++) {
      cross(polygon[previous], polygon[i], y_begin * kSubRows, y_end * kSubRows);
    }
    for (int y = y_begin; y < y_end; ++y) fill_row(y, row);
  }

 private:
  static constexpr int kSubRows = 8;
  static constexpr std::size_t kMaxCrossings = 8;  // of a line; more are left out in pairs

  struct Line {
    std::size_t count = 0;
    std::array<double, kMaxCrossings> x;
  };

  Line& line(int index) { return lines_[static_cast<std::size_t>(index)]; }

  // Where the edge from a to b crosses the lines at heights (i + 1/2) / kSubRows.
  void cross(Eigen::Vector2d a, Eigen::Vector2d b, int first, int last) {
    if (a.y() == b.y()) return;
    if (a.y() > b.y()) std::swap(a, b);
    const double slope = (b.x() - a.x()) / (b.y() - a.y());
    const auto index = [&](double y) {
      return static_cast<int>(std::ceil(std::clamp<double>(kSubRows * y - 0.5, first, last)));
    };
    const int end = index(b.y());
    for (int i = index(a.y()); i < end; ++i) {
      Line& crossed = line(i);
      if (crossed.count == kMaxCrossings) continue;
      const double x = a.x() + slope * ((i + 0.5) / kSubRows - a.y());
      crossed.x[crossed.count++] = std::clamp<double>(x, 0.0, width_);
    }
  }

  template <class Row>
  void fill_row(int y, Row&& row) {
    bool simple = true;  // each line is covered in one piece
    double outer_begin = width_, outer_end = 0.0, inner_begin = 0.0, inner_end = width_;
    for (int k = 0; k < kSubRows; ++k) {
      Line& crossed = line(y * kSubRows + k);
      crossed.count -= crossed.count % 2;
      simple = simple && crossed.count == 2;
      if (crossed.count == 0) continue;
      const auto end = crossed.x.begin() + static_cast<std::ptrdiff_t>(crossed.count);
      if (crossed.count > 2) {
        std::sort(crossed.x.begin(), end);
      } else if (crossed.x[1] < crossed.x[0]) {
        std::swap(crossed.x[0], crossed.x[1]);
      }
      outer_begin = std::min(outer_begin, crossed.x[0]);
      outer_end = std::max(outer_end, *(end - 1));
      inner_begin = std::max(inner_begin, crossed.x[0]);
      inner_end = std::min(inner_end, *(end - 1));
    }
    const int begin = static_cast<int>(std::floor(outer_begin));
    const int end = static_cast<int>(std::ceil(outer_end));
    if (begin >= end) return;
    int full_begin = end, full_end = end;
    if (simple && std::ceil(inner_begin) < std::floor(inner_end)) {
      full_begin = static_cast<int>(std::ceil(inner_begin));
      full_end = static_cast<int>(std::floor(inner_end));
    }
    fill_partly(y, begin, full_begin, row);
    if (full_begin < full_end) row(y, full_begin, full_end, static_cast<const float*>(nullptr));
    fill_partly(y, full_end, end, row);
  }

  template <class Row>
  void fill_partly(int y, int from, int to, Row&& row) {
    if (from >= to) return;
    std::fill(sums_.begin() + from, sums_.begin() + to, 0.0);
    for (int k = 0; k < kSubRows; ++k) {
      const Line& crossed = line(y * kSubRows + k);
      for (std::size_t i = 0; i < crossed.count; i += 2) {
        add_length(crossed.x[i], crossed.x[i + 1], from, to);
      }
    }
    for (int x = from; x < to; ++x) {
      const auto pixel = static_cast<std::size_t>(x);
      coverage_[pixel] = static_cast<float>(sums_[pixel] / kSubRows);
    }
    row(y, from, to, static_cast<const float*>(coverage_.data() + from));
  }

  // What the piece from `left` to `right` of a line covers of each of the pixels `from` to `to`.
  void add_length(double left, double right, int from, int to) {
    const int begin = std::max(from, static_cast<int>(left));
    const int end = std::min(to, static_cast<int>(std::ceil(right)));
    double* sums = sums_.data();
    for (int x = begin; x < end; ++x) {
      sums[x] += std::max(0.0, std::min<double>(right, x + 1) - std::max<double>(left, x));
    }
  }

  int width_, height_;
  std::vector<Line> lines_;
  std::vector<double> sums_;
  std::vector<float> coverage_;
};

}  // namespace camera_sim
