// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/rigid_tree.hpp"

#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>

namespace v60_gait {
namespace {

constexpr double kInertiaTolerance = 1e-9;  // relative

Eigen::Vector3d to_eigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d to_eigen(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const urdf::Rotation& r = pose.rotation;
  result.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).toRotationMatrix();
  result.translation() = to_eigen(pose.position);
  return result;
}

// Inertia of a point mass about the origin: m (|d|^2 1 - d d^T), Steiner's term.
Eigen::Matrix3d point_inertia(double mass, const Eigen::Vector3d& d) {
  return mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
}

void add_inertial(const urdf::Inertial& inertial, const Eigen::Isometry3d& link_pose,
                  RigidBody& body) {
  const Eigen::Isometry3d pose = link_pose * to_eigen(inertial.origin);
  Eigen::Matrix3d inertia;
  inertia << inertial.ixx, inertial.ixy, inertial.ixz,  //
      inertial.ixy, inertial.iyy, inertial.iyz,         //
      inertial.ixz, inertial.iyz, inertial.izz;
  const double mass = body.mass + inertial.mass;
  if (mass == 0.0) return;
  const Eigen::Vector3d centre =
      (body.mass * body.centre_of_mass + inertial.mass * pose.translation()) / mass;
  body.inertia += point_inertia(body.mass, body.centre_of_mass - centre) +
                  pose.linear() * inertia * pose.linear().transpose() +
                  point_inertia(inertial.mass, pose.translation() - centre);
  body.mass = mass;
  body.centre_of_mass = centre;
}

CollisionPrimitive to_primitive(const urdf::Collision& collision, const std::string& link,
                                const Eigen::Isometry3d& link_pose) {
  CollisionPrimitive primitive;
  primitive.link = link;
  primitive.pose = link_pose * to_eigen(collision.origin);
  switch (collision.geometry->type) {
    case urdf::Geometry::SPHERE: {
      const auto& sphere = dynamic_cast<const urdf::Sphere&>(*collision.geometry);
      primitive.kind = CollisionPrimitive::Kind::kSphere;
      primitive.size = {sphere.radius, 0.0, 0.0};
      return primitive;
    }
    case urdf::Geometry::BOX: {
      primitive.kind = CollisionPrimitive::Kind::kBox;
      primitive.size = to_eigen(dynamic_cast<const urdf::Box&>(*collision.geometry).dim);
      return primitive;
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(*collision.geometry);
      primitive.kind = CollisionPrimitive::Kind::kCylinder;
      primitive.size = {cylinder.radius, 0.0, cylinder.length};
      return primitive;
    }
    default:
      throw std::invalid_argument("collision shape of link '" + link +
                                  "' is a mesh, must be a sphere, box or cylinder");
  }
}

RobotJoint to_joint(const urdf::Joint& joint, int body) {
  RobotJoint result;
  result.name = joint.name;
  result.body = body;
  result.has_position_limits = joint.type == urdf::Joint::REVOLUTE;
  if (joint.limits) {
    result.lower = joint.limits->lower;
    result.upper = joint.limits->upper;
    result.max_velocity = joint.limits->velocity;
    result.max_effort = joint.limits->effort;
  }
  return result;
}

void grow(const urdf::Link& link, int body, const Eigen::Isometry3d& link_pose, RigidTree& tree);

void add_moving_body(const urdf::Joint& joint, const urdf::Link& link, int parent,
                     const Eigen::Isometry3d& parent_link_pose, RigidTree& tree) {
  const Eigen::Vector3d axis = to_eigen(joint.axis);
  if (!(axis.norm() > 0.0)) {
    throw std::invalid_argument("joint '" + joint.name + "' has an axis of zero length");
  }
  RigidBody body;
  body.name = link.name;
  body.parent = parent;
  body.joint_in_parent = parent_link_pose * to_eigen(joint.parent_to_joint_origin_transform);
  body.axis = axis.normalized();
  const int index = static_cast<int>(tree.bodies.size());
  tree.bodies.push_back(body);
  tree.joints.push_back(to_joint(joint, index));
  grow(link, index, Eigen::Isometry3d::Identity(), tree);
}

void grow(const urdf::Link& link, int body, const Eigen::Isometry3d& link_pose, RigidTree& tree) {
  tree.links[link.name] = {body, link_pose};
  const auto index = static_cast<std::size_t>(body);
  if (link.inertial) add_inertial(*link.inertial, link_pose, tree.bodies[index]);
  for (const auto& collision : link.collision_array) {
    tree.bodies[index].primitives.push_back(to_primitive(*collision, link.name, link_pose));
  }
  for (std::size_t i = 0; i < link.child_links.size(); ++i) {
    const urdf::Joint& joint = *link.child_joints[i];
    const urdf::Link& child = *link.child_links[i];
    switch (joint.type) {
      case urdf::Joint::FIXED:
        grow(child, body, link_pose * to_eigen(joint.parent_to_joint_origin_transform), tree);
        break;
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        add_moving_body(joint, child, body, link_pose, tree);
        break;
      default:
        throw std::invalid_argument("joint '" + joint.name +
                                    "' must be revolute, continuous or fixed");
    }
  }
}

void require_solid(const RigidBody& body) {
  if (!(body.mass > 0.0)) {
    throw std::invalid_argument("mass of link '" + body.name + "' is " + std::to_string(body.mass) +
                                ", must be above 0");
  }
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(body.inertia, Eigen::EigenvaluesOnly)
          .eigenvalues();
  const double slack = kInertiaTolerance * moments[2];
  if (!(moments[0] > 0.0) || !(moments[0] + moments[1] >= moments[2] - slack)) {
    throw std::invalid_argument("inertia of link '" + body.name +
                                "' is of no solid: principal moments must be positive and none "
                                "above the sum of the others");
  }
}

}  // namespace

RigidTree rigid_tree_from_urdf(const std::string& urdf_xml, bool fixed_base) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf_xml);
  if (!model || !model->getRoot()) {
    throw std::invalid_argument("robot description is not a valid URDF");
  }
  RigidTree tree;
  tree.bodies.emplace_back();
  tree.bodies.front().name = model->getRoot()->name;
  grow(*model->getRoot(), 0, Eigen::Isometry3d::Identity(), tree);
  for (std::size_t i = fixed_base ? 1 : 0; i < tree.bodies.size(); ++i) {
    require_solid(tree.bodies[i]);
  }
  return tree;
}

}  // namespace v60_gait
