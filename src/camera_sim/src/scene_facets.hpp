// SPDX-License-Identifier: BSD-3-Clause
// The camera's surroundings as plane facets of one grey level each, and what is printed on them.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "camera_sim/camera_renderer.hpp"
#include "camera_sim/grid_texture.hpp"
#include "camera_sim/target_box.hpp"

namespace camera_sim {

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
  bool carries_tag = false;
};

// A texture on a surface, seen from where z > 0.
struct Print {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  // of its centre: x right, y up, z out
  double cell = 0.0;                                       // edge length of a cell, m
  GridTexture texture;

  // Lower left, lower right, upper right, upper left.
  [[nodiscard]] std::array<Eigen::Vector3d, 4> corners() const;
};

// In the platform frame; everything else is above its plane z = 0.
[[nodiscard]] Body platform_body();

// Chassis of the cart, post, back wall, left, right, top and bottom wall of the box, in the frame
// of what carries them.
[[nodiscard]] std::vector<Body> target_bodies(const TargetBox& target);
[[nodiscard]] Print tag_print(const TargetBox& target);

// Inside of a laboratory room around the world's origin, in world; painted in this order. Its floor
// is below the platform, or at z = 0 when the box is on a cart.
[[nodiscard]] std::vector<Facet> room_facets(const TargetBox& target);
// On the room's walls.
[[nodiscard]] std::vector<Print> room_posters(const TargetBox& target, const Clutter& clutter);

}  // namespace camera_sim
