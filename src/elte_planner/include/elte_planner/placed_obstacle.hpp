// SPDX-License-Identifier: BSD-3-Clause
//
// What a plan keeps clear of: spheres and boxes that rest in the planning frame, spheres that move
// with the target.
#pragma once

#include <prf_core/se3.hpp>
#include <string>
#include <vector>

#include "elte_planner/obstacle.hpp"

namespace elte_planner {

struct PlacedObstacle {
  Obstacle shape;          // m, in the planning frame or in the target's
  bool on_target = false;  // a sphere only: boxes lie along the axes of the planning frame

  // In the planning frame, for the target there.
  Obstacle in_planning_frame(const prf_core::Pose& target) const;
};

// Entries separated by ';' (none: no obstacle), all numbers in m:
//   sphere [on_target] X Y Z RADIUS
//   box X Y Z HALF_X HALF_Y HALF_Z
// Throws std::invalid_argument for anything else, naming the entry.
[[nodiscard]] std::vector<PlacedObstacle> obstacles_from(const std::string& text);

}  // namespace elte_planner
