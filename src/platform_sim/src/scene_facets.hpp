// SPDX-License-Identifier: BSD-3-Clause
// The camera's surroundings as plane facets of one grey level each.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "platform_sim/target_box.hpp"

namespace platform_sim {

struct Facet {
  std::array<Eigen::Vector3d, 4> corners;  // a parallelogram, counter-clockwise seen from in front
  unsigned char grey = 0;

  [[nodiscard]] Eigen::Vector3d normal() const {  // toward the viewer in front, not normalised
    return (corners[1] - corners[0]).cross(corners[3] - corners[0]);
  }
};

// A convex body and a plane that has the body on its negative side and all bodies after it in a
// list on its positive side.
struct Body {
  std::vector<Facet> facets;
  Eigen::Hyperplane<double, 3> separator;
};

// Deck, post, back wall, left, right, top and bottom wall of the box, in the platform frame.
// The tag's place in the list is right after kBackWall.
inline constexpr std::size_t kBackWall = 2;
[[nodiscard]] std::vector<Body> platform_bodies(const TargetBox& target);

// Inside of a laboratory room around the world's origin, in world; painted in this order.
[[nodiscard]] std::vector<Facet> room_facets();

}  // namespace platform_sim
