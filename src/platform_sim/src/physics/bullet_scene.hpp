// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "platform_sim/contacts.hpp"

namespace platform_sim {

/// Bits of the groups an object belongs to (`group`) and may touch (`mask`).
struct CollisionFilter {
  int group = 0;
  int mask = 0;
};

/// Names of a collider's child shapes, carried as its user pointer; one name stands for all.
struct ColliderLabel {
  std::vector<std::string> shape_names;
};

/// Bullet's world with gravity along -z, sequential impulses and a friction cone. Whatever is added
/// must be destroyed before it.
class BulletScene {
 public:
  explicit BulletScene(double time_step);

  void step();
  [[nodiscard]] double time_step() const { return time_step_; }
  [[nodiscard]] btMultiBodyDynamicsWorld& world() { return *world_; }
  /// Points of the last step that carry force.
  [[nodiscard]] std::vector<ContactPoint> contact_points() const;

 private:
  double time_step_;
  std::unique_ptr<btDefaultCollisionConfiguration> configuration_;
  std::unique_ptr<btCollisionDispatcher> dispatcher_;
  std::unique_ptr<btDbvtBroadphase> broadphase_;
  std::unique_ptr<btMultiBodyConstraintSolver> solver_;
  std::unique_ptr<btMultiBodyDynamicsWorld> world_;
};

/// Kinematic body of cuboids: goes where it is put and carries what stands on it. Bullet derives
/// its velocity from successive poses.
class CuboidBody {
 public:
  using Part = std::pair<Eigen::Isometry3d, Eigen::Vector3d>;  // pose in the body, edge lengths

  CuboidBody(BulletScene& scene, std::string name, const std::vector<Part>& parts,
             const CollisionFilter& filter, const Eigen::Isometry3d& pose);
  ~CuboidBody();
  CuboidBody(const CuboidBody&) = delete;
  CuboidBody& operator=(const CuboidBody&) = delete;

  /// Pose at the end of the coming step.
  void move_to(const Eigen::Isometry3d& pose);

 private:
  BulletScene& scene_;
  ColliderLabel label_;
  std::vector<std::unique_ptr<btBoxShape>> boxes_;
  std::unique_ptr<btCompoundShape> shape_;
  std::unique_ptr<btRigidBody> body_;
};

}  // namespace platform_sim
