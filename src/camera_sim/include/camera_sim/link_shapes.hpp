// SPDX-License-Identifier: BSD-3-Clause
// Visual shapes of a robot's links as triangles.
#pragma once

#include <urdf_parser/urdf_parser.h>

#include <string>
#include <vector>

#include "camera_sim/triangle_mesh.hpp"
#include "camera_sim/z_buffer.hpp"

namespace camera_sim {

struct LinkShape {
  Mesh mesh;
  Eigen::Isometry3d pose;  // in the link
  Colour colour;
};

// Throws std::invalid_argument for text that is no robot description (URDF).
[[nodiscard]] urdf::ModelInterfaceSharedPtr parse_robot(const std::string& urdf_xml);
// Boxes, cylinders and spheres; throws std::invalid_argument for other shapes.
[[nodiscard]] std::vector<LinkShape> shapes_of(const urdf::Link& link);
[[nodiscard]] Eigen::Isometry3d to_eigen(const urdf::Pose& pose);

}  // namespace camera_sim
