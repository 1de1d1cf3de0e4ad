// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bullet_scene.hpp"
#include "platform_sim/frame_state.hpp"
#include "v60_gait/rigid_tree.hpp"

namespace platform_sim {

/// How a rigid body of the robot touches others; asked for with the name of its first link.
struct RobotSurface {
  std::string name;  ///< in contacts; empty: the name of each shape's link
  CollisionFilter filter;
  double friction = 0.0;
  double stiffness = 0.0;  ///< N/m
  double damping = 0.0;    ///< N s/m
};
using SurfaceRule = std::function<RobotSurface(const std::string& body)>;

/// A btMultiBody built from a URDF, see v60_gait::rigid_tree_from_urdf().
///
/// Bullet puts a body's frame at its centre of mass along the principal axes; poses in this
/// interface are those of the URDF's links.
class RobotModel {
 public:
  enum class Base { kFixed, kFloating };

  /// Throws what v60_gait::rigid_tree_from_urdf() throws. The scene must outlive the robot.
  RobotModel(BulletScene& scene, const std::string& urdf_xml, Base base, const SurfaceRule& rule);
  ~RobotModel();
  RobotModel(const RobotModel&) = delete;
  RobotModel& operator=(const RobotModel&) = delete;

  [[nodiscard]] btMultiBody& multibody() { return *multibody_; }
  [[nodiscard]] const v60_gait::RigidTree& tree() const { return tree_; }
  [[nodiscard]] const std::vector<v60_gait::RobotJoint>& joints() const { return tree_.joints; }
  /// Throws std::invalid_argument if there is none.
  [[nodiscard]] const v60_gait::RobotJoint& joint(const std::string& name) const;
  [[nodiscard]] double mass() const;
  /// Radius of the collision sphere of a link, m; throws std::invalid_argument if it has none.
  [[nodiscard]] double sphere_radius(const std::string& link) const;

  [[nodiscard]] double position(const v60_gait::RobotJoint& joint) const;
  [[nodiscard]] double velocity(const v60_gait::RobotJoint& joint) const;
  /// Teleports; call update_poses() after the last one.
  void set_position(const v60_gait::RobotJoint& joint, double position);
  void set_base_pose(const Eigen::Isometry3d& pose);
  void update_poses();
  void set_at_rest();

  [[nodiscard]] FrameState frame(const std::string& link) const;
  [[nodiscard]] Eigen::Vector3d gravity() const;         ///< m/s2, world
  [[nodiscard]] Eigen::Vector3d centre_of_mass() const;  ///< m, world
  /// Torques of gravity about the joints, Nm, in the order of joints().
  [[nodiscard]] Eigen::VectorXd gravity_torques() const;
  void apply_torque(const v60_gait::RobotJoint& joint, double torque);
  /// Force at the origin of the link's frame and torque, in world axes, for one step.
  void apply_wrench(const std::string& link, const Eigen::Vector3d& force,
                    const Eigen::Vector3d& torque);

 private:
  struct Collider {
    ColliderLabel label;
    std::unique_ptr<btCollisionShape> shape;
    std::unique_ptr<btMultiBodyLinkCollider> object;
  };

  void add_bodies(Base base);
  void add_collider(int body, const RobotSurface& surface);
  void add_position_limits();
  [[nodiscard]] Eigen::Isometry3d centre_pose(int body) const;  // Bullet's frame in world
  [[nodiscard]] FrameState centre_state(int body) const;
  [[nodiscard]] const v60_gait::LinkFrame& find_link(const std::string& name) const;

  BulletScene& scene_;
  v60_gait::RigidTree tree_;
  std::vector<Eigen::Isometry3d> centre_in_link_;  // Bullet's frame of a body in its first link's
  std::unique_ptr<btMultiBody> multibody_;
  std::vector<std::unique_ptr<btCollisionShape>> primitives_;
  std::vector<Collider> colliders_;
  std::vector<std::unique_ptr<btMultiBodyJointLimitConstraint>> limits_;
};

}  // namespace platform_sim
