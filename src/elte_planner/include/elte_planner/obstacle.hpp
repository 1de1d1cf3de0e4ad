// SPDX-License-Identifier: BSD-3-Clause
//
// Convex obstacles of any dimension and their distance from the segments of a plan.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace elte_planner {

struct Obstacle {
  enum class Shape { kDisc, kBox };

  static Obstacle disc(Eigen::VectorXd centre, double radius);  // in 3-D a sphere
  static Obstacle box(Eigen::VectorXd centre, Eigen::VectorXd half_widths);
  // A box along the columns of `axes`, orthonormal.
  static Obstacle box(Eigen::VectorXd centre, Eigen::VectorXd half_widths, Eigen::MatrixXd axes);

  void validate(Eigen::Index dimensions) const;  // throws std::invalid_argument

  // Largest value of direction . (x - centre) over the obstacle.
  double reach(const Eigen::VectorXd& direction) const;

  Shape shape = Shape::kDisc;
  Eigen::VectorXd centre;
  double radius = 0.0;
  Eigen::VectorXd half_widths;
  Eigen::MatrixXd axes;  // of a box, columns; empty: those of the coordinates
};

// An obstacle's places, one for each node of a plan: [k] while the segment that ends in node k is
// executed.
using MovingObstacle = std::vector<Obstacle>;

struct Separation {
  double distance = 0.0;   // Euclidean, 0 when they meet
  Eigen::VectorXd normal;  // unit, from the obstacle to the segment; empty when they meet
};

[[nodiscard]] Separation separation(const Obstacle& obstacle, const Eigen::VectorXd& from,
                                    const Eigen::VectorXd& to);

// Least distance of the polyline through the rows of y from any of the obstacles; infinity for
// none.
[[nodiscard]] double polyline_clearance(const Eigen::MatrixXd& y,
                                        const std::vector<Obstacle>& obstacles);

// Least distance of the segments that end in nodes `first` (>= 1) and later from obstacles at rest
// and in motion; infinity for none.
[[nodiscard]] double plan_clearance(const Eigen::MatrixXd& y, Eigen::Index first,
                                    const std::vector<Obstacle>& obstacles,
                                    const std::vector<MovingObstacle>& moving);

}  // namespace elte_planner
