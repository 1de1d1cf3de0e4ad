// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/link_shapes.hpp"

#include <stdexcept>

namespace camera_sim {
namespace {

const Colour kDefault(0.6, 0.6, 0.6);

Mesh to_mesh(const urdf::Geometry& geometry, const std::string& link) {
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = dynamic_cast<const urdf::Box&>(geometry).dim;
      return box_mesh({size.x, size.y, size.z});
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
      return cylinder_mesh(cylinder.radius, cylinder.length);
    }
    case urdf::Geometry::SPHERE:
      return sphere_mesh(dynamic_cast<const urdf::Sphere&>(geometry).radius);
    default:
      throw std::invalid_argument("link " + link +
                                  " has a mesh, must be of boxes, cylinders and spheres");
  }
}

}  // namespace

urdf::ModelInterfaceSharedPtr parse_robot(const std::string& urdf_xml) {
  urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf_xml);
  if (!model || !model->getRoot()) {
    throw std::invalid_argument(
        "robot description is no valid URDF; the lines above say where, and so does `check_urdf "
        "FILE`");
  }
  return model;
}

std::vector<LinkShape> shapes_of(const urdf::Link& link) {
  std::vector<LinkShape> shapes;
  for (const auto& visual : link.visual_array) {
    LinkShape shape{to_mesh(*visual->geometry, link.name), to_eigen(visual->origin), kDefault};
    if (visual->material) {
      const urdf::Color& colour = visual->material->color;
      shape.colour = Colour(colour.r, colour.g, colour.b);
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

Eigen::Isometry3d to_eigen(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() =
      Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z)
          .toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

}  // namespace camera_sim
