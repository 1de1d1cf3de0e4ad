// SPDX-License-Identifier: BSD-3-Clause
#include "bullet_scene.hpp"

#include "eigen_bullet.hpp"
#include "v60_gait/gravity.hpp"

namespace platform_sim {
namespace {

constexpr int kSolverIterations = 20;  // Bullet's default is 10

const std::string& shape_name(const btCollisionObject& object, int child) {
  const auto& names = static_cast<const ColliderLabel*>(object.getUserPointer())->shape_names;
  const auto index = static_cast<std::size_t>(child < 0 ? 0 : child);
  return names.size() == 1 ? names.front() : names.at(index);
}

}  // namespace

BulletScene::BulletScene(double time_step)
    : time_step_(time_step),
      configuration_(std::make_unique<btDefaultCollisionConfiguration>()),
      dispatcher_(std::make_unique<btCollisionDispatcher>(configuration_.get())),
      broadphase_(std::make_unique<btDbvtBroadphase>()),
      solver_(std::make_unique<btMultiBodyConstraintSolver>()),
      world_(std::make_unique<btMultiBodyDynamicsWorld>(dispatcher_.get(), broadphase_.get(),
                                                        solver_.get(), configuration_.get())) {
  world_->setGravity(btVector3(0.0, 0.0, -v60_gait::kGravity));
  world_->getSolverInfo().m_numIterations = kSolverIterations;
}

void BulletScene::step() { world_->stepSimulation(time_step_, 0); }

std::vector<ContactPoint> BulletScene::contact_points() const {
  std::vector<ContactPoint> points;
  for (int m = 0; m < dispatcher_->getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_->getManifoldByIndexInternal(m);
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      if (point.getAppliedImpulse() <= 0.0) continue;
      points.push_back({shape_name(*manifold.getBody0(), point.m_index0),
                        shape_name(*manifold.getBody1(), point.m_index1),
                        point.getAppliedImpulse() / time_step_,
                        to_eigen(point.getPositionWorldOnB())});
    }
  }
  return points;
}

CuboidBody::CuboidBody(BulletScene& scene, std::string name, const std::vector<Part>& parts,
                       const CollisionFilter& filter, const Eigen::Isometry3d& pose)
    : scene_(scene), label_{{std::move(name)}}, shape_(std::make_unique<btCompoundShape>()) {
  for (const auto& [part_pose, size] : parts) {
    boxes_.push_back(std::make_unique<btBoxShape>(to_bullet(Eigen::Vector3d(0.5 * size))));
    shape_->addChildShape(to_bullet(part_pose), boxes_.back().get());
  }
  btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, shape_.get());
  info.m_startWorldTransform = to_bullet(pose);
  info.m_friction = 1.0;  // Bullet multiplies the two coefficients: the robot's decides
  body_ = std::make_unique<btRigidBody>(info);
  body_->setUserPointer(&label_);
  body_->setActivationState(DISABLE_DEACTIVATION);
  body_->setCollisionFlags(body_->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  scene_.world().addRigidBody(body_.get(), filter.group, filter.mask);
}

CuboidBody::~CuboidBody() { scene_.world().removeRigidBody(body_.get()); }

void CuboidBody::move_to(const Eigen::Isometry3d& pose) {
  body_->setWorldTransform(to_bullet(pose));
}

}  // namespace platform_sim
