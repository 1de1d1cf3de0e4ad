// SPDX-License-Identifier: BSD-3-Clause
//
// What a plan keeps clear of: spheres and boxes that rest in the planning frame or move with the
// target.
#pragma once

#include <prf_core/se3.hpp>
#include <string>
#include <vector>

#include "elte_planner/obstacle.hpp"

namespace elte_planner {

struct PlacedObstacle {
  Obstacle shape;  // m, in the planning frame or in the target's
  bool on_target = false;

  // In the planning frame, for the target there.
  Obstacle in_planning_frame(const prf_core::Pose& target) const;
};

// Entries separated by ';' (none: no obstacle), all numbers in m:
//   sphere [on_target] X Y Z RADIUS
//   box [on_target] X Y Z HALF_X HALF_Y HALF_Z
// Throws std::invalid_argument for anything else, naming the entry.
constexpr std::size_t kMostObstacles = 8;  // each makes a plan dearer
[[nodiscard]] std::vector<PlacedObstacle> obstacles_from(const std::string& text);

// A place that the hand passes: the node nearest to this share of the path comes within an l1 ball
// around it.
struct PlacedVia {
  double share = 0.0;      // of the path's nodes, within (0, 1)
  Eigen::Vector3d centre;  // m, in the planning frame or in the target's
  double radius = 0.0;     // m
  bool on_target = false;

  Eigen::Index node(int nodes) const;
  Eigen::Vector3d in_planning_frame(const prf_core::Pose& target) const;
};

// Entries separated by ';' (none: no via-point): SHARE [on_target] X Y Z RADIUS, all but SHARE in
// m. Throws std::invalid_argument for anything else, naming the entry.
[[nodiscard]] std::vector<PlacedVia> via_points_from(const std::string& text);

}  // namespace elte_planner
