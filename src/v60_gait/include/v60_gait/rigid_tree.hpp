// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

namespace v60_gait {

struct RobotJoint {
  std::string name;
  int body = 0;  ///< index of the body that it moves
  bool has_position_limits = false;
  double lower = 0.0;         ///< rad
  double upper = 0.0;         ///< rad
  double max_velocity = 0.0;  ///< rad/s, 0 if the URDF has none
  double max_effort = 0.0;    ///< Nm, 0 if the URDF has none
};

struct CollisionPrimitive {
  enum class Kind { kSphere, kBox, kCylinder };
  Kind kind = Kind::kSphere;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< m; box: edges; sphere: (radius, -, -);
  ///< cylinder: (radius, -, length along z)
  std::string link;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the body's first link
};

/// Links that fixed joints hold together, in the frame of the one nearest to the root (the first
/// link). Vectors and inertia are in that frame's axes.
struct RigidBody {
  std::string name;  ///< first link
  int parent = -1;
  Eigen::Isometry3d joint_in_parent = Eigen::Isometry3d::Identity();  ///< in the parent's frame
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();                    ///< of its joint
  double mass = 0.0;                                                  ///< kg
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();           ///< m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass, kg m2
  std::vector<CollisionPrimitive> primitives;
};

struct LinkFrame {
  int body = 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the body's first link
};

/// A robot as a tree of rigid bodies and one-axis rotary joints; bodies[0] is the base, joints[i]
/// moves bodies[i + 1], parents come before children.
struct RigidTree {
  std::vector<RigidBody> bodies;
  std::vector<RobotJoint> joints;
  std::map<std::string, LinkFrame> links;  ///< every link of the URDF
};

/// Throws std::invalid_argument for text that is no URDF, joints other than revolute, continuous
/// and fixed, meshes as collision shapes, and moving bodies without mass or with an inertia that
/// is not positive definite or violates the triangle inequality of principal moments. With
/// `fixed_base` the base need not have mass.
[[nodiscard]] RigidTree rigid_tree_from_urdf(const std::string& urdf_xml, bool fixed_base);

}  // namespace v60_gait
