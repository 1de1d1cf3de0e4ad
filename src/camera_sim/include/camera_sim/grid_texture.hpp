// SPDX-License-Identifier: BSD-3-Clause
// A rectangle printed with square cells of one grey level each. Its mean grey level over a pixel
// can be asked for.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace camera_sim {

class GridTexture {
 public:
  // `greys` row by row, from the upper left cell; an incomplete last row is ignored.
  GridTexture(int columns, std::vector<unsigned char> greys);

  // Cell coordinates (u, v) run from (0, 0) at the upper left corner, u to the right, v down.
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }

  // Grey level of the cell in column u and row v.
  [[nodiscard]] unsigned char at(int u, int v) const {
    return greys_[static_cast<std::size_t>(v * columns_ + u)];
  }

  // Mean over a pixel with its centre at `cell`; `derivative` is d cell / d pixel. Points outside
  // count as the nearest cell.
  [[nodiscard]] unsigned char mean_over_pixel(const Eigen::Vector2d& cell,
                                              const Eigen::Matrix2d& derivative) const;

 private:
  // Of a pixel that covers more than 2 x 2 cells, with its corner at `origin`.
  [[nodiscard]] unsigned char mean_of_many(const Eigen::Vector2d& origin,
                                           const Eigen::Matrix2d& derivative) const;
  [[nodiscard]] static int index(double coordinate, int count) {
    return std::clamp(static_cast<int>(coordinate), 0, count - 1);
  }

  int columns_, rows_;
  std::vector<unsigned char> greys_;
};

// Face of tag 0 of the family tag36h11 with its white border, one cell a module.
[[nodiscard]] GridTexture tag_texture();
// Cells along one side of the black border: what "tag size" measures.
[[nodiscard]] inline int black_side(const GridTexture& tag) { return tag.columns() - 2; }

}  // namespace camera_sim
