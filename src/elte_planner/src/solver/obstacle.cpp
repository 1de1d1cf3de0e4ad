// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "elte_planner/elte_energy.hpp"

namespace elte_planner {
namespace {

// In the box' axes, from its centre.
Eigen::VectorXd in_box(const Obstacle& box, const Eigen::VectorXd& x) {
  if (box.axes.size() == 0) return x - box.centre;
  return box.axes.transpose() * (x - box.centre);
}

// From the nearest point of the box to x, both in its axes.
Eigen::VectorXd beyond_box(const Obstacle& box, const Eigen::VectorXd& x) {
  return x - x.cwiseMax(-box.half_widths).cwiseMin(box.half_widths);
}

// Where on the segment the distance from the box is least. Half the derivative of its square is
// non-decreasing and linear between the places where a coordinate meets a face. In the box' axes.
double nearest_to_box(const Obstacle& box, const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
  const Eigen::VectorXd direction = to - from;
  std::vector<double> breaks = {0.0, 1.0};
  for (Eigen::Index j = 0; j < direction.size(); ++j) {
    if (direction[j] == 0.0) continue;
    for (const double side : {-1.0, 1.0}) {
      const double t = (side * box.half_widths[j] - from[j]) / direction[j];
      if (t > 0.0 && t < 1.0) breaks.push_back(t);
    }
  }
  std::sort(breaks.begin(), breaks.end());
  const auto slope = [&](double t) { return direction.dot(beyond_box(box, from + t * direction)); };
  double before = slope(0.0);
  if (before >= 0.0) return 0.0;
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const double after = slope(breaks[i]);
    if (after >= 0.0) {
      return breaks[i - 1] - before / (after - before) * (breaks[i] - breaks[i - 1]);
    }
    before = after;
  }
  return 1.0;
}

double nearest_to_point(const Eigen::VectorXd& point, const Eigen::VectorXd& from,
                        const Eigen::VectorXd& to) {
  const Eigen::VectorXd direction = to - from;
  const double square = direction.squaredNorm();
  return square > 0.0 ? std::clamp(direction.dot(point - from) / square, 0.0, 1.0) : 0.0;
}

}  // namespace

Obstacle Obstacle::disc(Eigen::VectorXd centre, double radius) {
  return {Shape::kDisc, std::move(centre), radius, {}, {}};
}

Obstacle Obstacle::box(Eigen::VectorXd centre, Eigen::VectorXd half_widths) {
  return {Shape::kBox, std::move(centre), 0.0, std::move(half_widths), {}};
}

Obstacle Obstacle::box(Eigen::VectorXd centre, Eigen::VectorXd half_widths, Eigen::MatrixXd axes) {
  return {Shape::kBox, std::move(centre), 0.0, std::move(half_widths), std::move(axes)};
}

void Obstacle::validate(Eigen::Index dimensions) const {
  const bool is_box = shape == Shape::kBox;
  if (centre.size() != dimensions || (is_box && half_widths.size() != dimensions)) {
    throw std::invalid_argument("obstacle has " + std::to_string(centre.size()) +
                                " coordinates, must have " + std::to_string(dimensions));
  }
  if (!is_within_magnitude(centre)) {
    throw std::invalid_argument("obstacle's centre is not finite or above 1e100");
  }
  const double least = is_box ? half_widths.minCoeff() : radius;
  if (!(least >= 0.0) || (is_box && !is_within_magnitude(half_widths)) ||
      !(radius <= kMaxMagnitude)) {
    throw std::invalid_argument("obstacle has a size of " + std::to_string(least) +
                                ", must be within [0, 1e100]");
  }
  if (axes.size() == 0) return;
  const bool square = axes.rows() == dimensions && axes.cols() == dimensions;
  if (!square || !axes.isUnitary(1e-6)) {
    throw std::invalid_argument("obstacle's axes are " + std::to_string(axes.rows()) + " x " +
                                std::to_string(axes.cols()) + ", must be " +
                                std::to_string(dimensions) + " orthonormal columns");
  }
}

double Obstacle::reach(const Eigen::VectorXd& direction) const {
  if (shape == Shape::kDisc) return radius * direction.norm();
  if (axes.size() == 0) return direction.cwiseAbs().dot(half_widths);
  return (axes.transpose() * direction).cwiseAbs().dot(half_widths);
}

Separation separation(const Obstacle& obstacle, const Eigen::VectorXd& from,
                      const Eigen::VectorXd& to) {
  Eigen::VectorXd offset;
  if (obstacle.shape == Obstacle::Shape::kBox) {
    const Eigen::VectorXd a = in_box(obstacle, from);
    const Eigen::VectorXd b = in_box(obstacle, to);
    offset = beyond_box(obstacle, a + nearest_to_box(obstacle, a, b) * (b - a));
    if (obstacle.axes.size() > 0) offset = obstacle.axes * offset;
  } else {
    const double t = nearest_to_point(obstacle.centre, from, to);
    offset = from + t * (to - from) - obstacle.centre;
  }
  const double distance = offset.norm() - obstacle.radius;
  if (!(distance > 0.0)) return {};
  return {distance, offset.normalized()};
}

double polyline_clearance(const Eigen::MatrixXd& y, const std::vector<Obstacle>& obstacles) {
  double least = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : obstacles) {
    for (Eigen::Index k = 0; k + 1 < y.rows(); ++k) {
      least = std::min(
          least, separation(obstacle, y.row(k).transpose(), y.row(k + 1).transpose()).distance);
    }
  }
  return least;
}

double plan_clearance(const Eigen::MatrixXd& y, Eigen::Index first,
                      const std::vector<Obstacle>& obstacles,
                      const std::vector<MovingObstacle>& moving) {
  double least = polyline_clearance(y.bottomRows(y.rows() - first + 1), obstacles);
  for (const MovingObstacle& places : moving) {
    for (Eigen::Index k = first; k < y.rows(); ++k) {
      const Obstacle& place = places[static_cast<std::size_t>(k)];
      least = std::min(least,
                       separation(place, y.row(k - 1).transpose(), y.row(k).transpose()).distance);
    }
  }
  return least;
}

}  // namespace elte_planner
