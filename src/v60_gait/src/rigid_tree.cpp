// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/rigid_tree.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <prf_core/bounds.hpp>
#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <stdexcept>

namespace v60_gait {
namespace {

using prf_core::quoted;
using prf_core::require_between;

constexpr double kInertiaTolerance = 1e-9;  // relative
// Beyond every part of a robot that walks, and small enough that sums and squares stay finite.
constexpr double kHeaviest = 1e4;        // kg
constexpr double kMostInertia = 1e5;     // kg m^2
constexpr double kLargestPart = 100.0;   // m, of shapes and from one frame to the next
constexpr double kSmallestPart = 1e-6;   // m
constexpr double kStrongestJoint = 1e6;  // Nm, rad/s

Eigen::Vector3d to_eigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

// `what` names the pose's owner in a refusal.
Eigen::Isometry3d to_eigen(const urdf::Pose& pose, const std::string& what) {
  prf_core::require_within("origin of " + what, to_eigen(pose.position), kLargestPart, "m");
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

Eigen::Vector3d principal_moments(const Eigen::Matrix3d& inertia) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

// Each part by itself: in the sum over a body a negative one would pass.
void add_inertial(const urdf::Inertial& inertial, const std::string& link,
                  const Eigen::Isometry3d& link_pose, RigidBody& body) {
  const std::string what = "link " + quoted(link);
  const Eigen::Isometry3d pose = link_pose * to_eigen(inertial.origin, "the inertia of " + what);
  Eigen::Matrix3d inertia;
  inertia << inertial.ixx, inertial.ixy, inertial.ixz,  //
      inertial.ixy, inertial.iyy, inertial.iyz,         //
      inertial.ixz, inertial.iyz, inertial.izz;
  require_between("mass of " + what, inertial.mass, 0.0, kHeaviest, "kg");
  prf_core::require_within("inertia of " + what, inertia.reshaped().eval(), kMostInertia, "kg m2");
  const double least = principal_moments(inertia)[0];
  prf_core::require(least >= -kInertiaTolerance * inertia.trace(),
                    "least principal moment of inertia of " + what, least, "0 kg m2 or above");
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

double checked_size(const std::string& what, double size) {
  require_between(what, size, kSmallestPart, kLargestPart, "m");
  return size;
}

CollisionPrimitive to_primitive(const urdf::Collision& collision, const std::string& link,
                                const Eigen::Isometry3d& link_pose) {
  const std::string what = "a collision shape of link " + quoted(link);
  CollisionPrimitive primitive;
  primitive.link = link;
  primitive.pose = link_pose * to_eigen(collision.origin, what);
  if (!collision.geometry) throw std::invalid_argument(what + " is missing, must be given");
  switch (collision.geometry->type) {
    case urdf::Geometry::SPHERE: {
      const auto& sphere = dynamic_cast<const urdf::Sphere&>(*collision.geometry);
      primitive.kind = CollisionPrimitive::Kind::kSphere;
      primitive.size = {checked_size("radius of " + what, sphere.radius), 0.0, 0.0};
      return primitive;
    }
    case urdf::Geometry::BOX: {
      primitive.kind = CollisionPrimitive::Kind::kBox;
      primitive.size = to_eigen(dynamic_cast<const urdf::Box&>(*collision.geometry).dim);
      for (const double side : primitive.size) checked_size("side of " + what, side);
      return primitive;
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(*collision.geometry);
      primitive.kind = CollisionPrimitive::Kind::kCylinder;
      primitive.size = {checked_size("radius of " + what, cylinder.radius), 0.0,
                        checked_size("length of " + what, cylinder.length)};
      return primitive;
    }
    default:
      throw std::invalid_argument(what + " is a mesh, must be a sphere, box or cylinder");
  }
}

RobotJoint to_joint(const urdf::Joint& joint, int body) {
  RobotJoint result;
  result.name = joint.name;
  result.body = body;
  result.has_position_limits = joint.type == urdf::Joint::REVOLUTE;
  const std::string what = "joint " + quoted(joint.name);
  if (result.has_position_limits && !joint.limits) {
    throw std::invalid_argument(what + " is revolute without limits, must have them");
  }
  if (joint.limits) {
    const urdf::JointLimits& limits = *joint.limits;
    constexpr double kMost = prf_core::kMaxJointPosition;
    require_between("lower limit of " + what, limits.lower, -kMost, kMost, "rad");
    require_between("upper limit of " + what, limits.upper, limits.lower, kMost, "rad");
    require_between("velocity limit of " + what, limits.velocity, 0.0, kStrongestJoint, "rad/s");
    require_between("effort limit of " + what, limits.effort, 0.0, kStrongestJoint, "Nm");
    result.lower = limits.lower;
    result.upper = limits.upper;
    result.max_velocity = limits.velocity;
    result.max_effort = limits.effort;
  }
  return result;
}

void grow(const urdf::Link& link, int body, const Eigen::Isometry3d& link_pose, RigidTree& tree);

void add_moving_body(const urdf::Joint& joint, const urdf::Link& link, int parent,
                     const Eigen::Isometry3d& parent_link_pose, RigidTree& tree) {
  const Eigen::Vector3d axis = to_eigen(joint.axis);
  require_between("length of the axis of joint " + quoted(joint.name), axis.norm(), 1e-6, 1e6);
  RigidBody body;
  body.name = link.name;
  body.parent = parent;
  body.joint_in_parent = parent_link_pose * to_eigen(joint.parent_to_joint_origin_transform,
                                                     "joint " + quoted(joint.name));
  body.axis = axis.normalized();
  const int index = static_cast<int>(tree.bodies.size());
  tree.bodies.push_back(body);
  tree.joints.push_back(to_joint(joint, index));
  grow(link, index, Eigen::Isometry3d::Identity(), tree);
}

void grow(const urdf::Link& link, int body, const Eigen::Isometry3d& link_pose, RigidTree& tree) {
  tree.links[link.name] = {body, link_pose};
  const auto index = static_cast<std::size_t>(body);
  if (link.inertial) add_inertial(*link.inertial, link.name, link_pose, tree.bodies[index]);
  for (const auto& collision : link.collision_array) {
    tree.bodies[index].primitives.push_back(to_primitive(*collision, link.name, link_pose));
  }
  for (std::size_t i = 0; i < link.child_links.size(); ++i) {
    const urdf::Joint& joint = *link.child_joints[i];
    const urdf::Link& child = *link.child_links[i];
    switch (joint.type) {
      case urdf::Joint::FIXED:
        grow(child, body,
             link_pose *
                 to_eigen(joint.parent_to_joint_origin_transform, "joint " + quoted(joint.name)),
             tree);
        break;
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        add_moving_body(joint, child, body, link_pose, tree);
        break;
      default:
        throw std::invalid_argument("joint " + quoted(joint.name) +
                                    " must be revolute, continuous or fixed");
    }
  }
}

void require_solid(const RigidBody& body) {
  const std::string what = "link " + quoted(body.name);
  prf_core::require(body.mass > 0.0, "mass of " + what, body.mass, "above 0 kg");
  const Eigen::Vector3d moments = principal_moments(body.inertia);
  const double slack = kInertiaTolerance * moments[2];
  if (!(moments[0] > 0.0) || !(moments[0] + moments[1] >= moments[2] - slack)) {
    throw std::invalid_argument("inertia of " + what +
                                " is of no solid: principal moments must be positive and none "
                                "above the sum of the others");
  }
}

}  // namespace

namespace {

// urdfdom logs what it cannot read, leaves it out, and goes on: without a link's mass, say.
class UrdfErrors : public console_bridge::OutputHandler {
 public:
  UrdfErrors() { console_bridge::useOutputHandler(this); }
  ~UrdfErrors() override { console_bridge::restorePreviousOutputHandler(); }
  UrdfErrors(const UrdfErrors&) = delete;
  UrdfErrors& operator=(const UrdfErrors&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  [[nodiscard]] const std::string& first() const { return first_; }

 private:
  std::string first_;
};

urdf::ModelInterfaceSharedPtr parse(const std::string& urdf_xml) {
  const UrdfErrors errors;
  urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf_xml);
  if (!errors.first().empty()) {
    throw std::invalid_argument("robot description: " + quoted(errors.first()));
  }
  if (!model || !model->getRoot()) {
    throw std::invalid_argument(
        "robot description is no valid URDF; the lines above say where, and so does `check_urdf "
        "FILE`");
  }
  return model;
}

}  // namespace

RigidTree rigid_tree_from_urdf(const std::string& urdf_xml, bool fixed_base) {
  const urdf::ModelInterfaceSharedPtr model = parse(urdf_xml);
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
