// SPDX-License-Identifier: BSD-3-Clause
// The printed face of tag 0 of the family tag36h11 and its mean grey level over a pixel.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace platform_sim {

class TagTexture {
 public:
  TagTexture();

  // Modules along one side, white border included. Module coordinates (u, v) run from (0, 0) at the
  // upper left corner of the border, u to the right, v down.
  [[nodiscard]] int side() const { return side_; }
  // Modules along one side of the black border: what "tag size" measures.
  [[nodiscard]] int black_side() const { return side_ - 2; }

  // Grey level of the module in column u and row v.
  [[nodiscard]] unsigned char at(int u, int v) const {
    return greys_[static_cast<std::size_t>(v * side_ + u)];
  }

  // Mean over the pixel [x, x+1) x [y, y+1); `to_modules` maps homogeneous pixel to module
  // coordinates. Points outside the tag count as its border.
  [[nodiscard]] unsigned char mean_over_pixel(const Eigen::Matrix3d& to_modules, double x,
                                              double y) const;

 private:
  // Row or column of a module coordinate.
  [[nodiscard]] int index(double module) const {
    return std::clamp(static_cast<int>(module), 0, side_ - 1);
  }

  int side_ = 0;
  std::vector<unsigned char> greys_;  // row by row
};

}  // namespace platform_sim
