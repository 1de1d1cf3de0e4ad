// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes of simple solids.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace camera_sim {

using Triangle = std::array<Eigen::Vector3d, 3>;  // counter-clockwise seen from outside
using Mesh = std::vector<Triangle>;

[[nodiscard]] Triangle transformed(const Eigen::Isometry3d& pose, const Triangle& triangle);

[[nodiscard]] Mesh box_mesh(const Eigen::Vector3d& size);
[[nodiscard]] Mesh cylinder_mesh(double radius, double length);  // along z, around the origin
[[nodiscard]] Mesh sphere_mesh(double radius);
// Rectangle of the plane z = 0 from `low` to `high`, seen from z > 0.
[[nodiscard]] Mesh rectangle_mesh(const Eigen::Vector2d& low, const Eigen::Vector2d& high);

}  // namespace camera_sim
