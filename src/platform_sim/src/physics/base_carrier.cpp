// SPDX-License-Identifier: BSD-3-Clause
#include "base_carrier.hpp"

#include <prf_core/se3.hpp>

#include "eigen_bullet.hpp"

namespace platform_sim {
namespace {

constexpr double kMaxForce = 1e5;  // N or Nm, far above what 150 m/s2 take
constexpr int kBase = -1;          // Bullet's number of a multibody's base

}  // namespace

BaseCarrier::BaseCarrier(BulletScene& scene, RobotModel& robot)
    : scene_(scene), robot_(robot), link_(robot.tree().bodies.front().name) {
  const btTransform base = to_bullet(robot.frame(link_).pose);
  const btTransform base_in_centre = robot.multibody().getBaseWorldTransform().inverse() * base;
  constraint_ = std::make_unique<btMultiBodyFixedConstraint>(
      &robot.multibody(), kBase, static_cast<btRigidBody*>(nullptr), base_in_centre.getOrigin(),
      base.getOrigin(), base_in_centre.getBasis(), base.getBasis());
  constraint_->setMaxAppliedImpulse(kMaxForce * scene.time_step());
  scene_.world().addMultiBodyConstraint(constraint_.get());
}

BaseCarrier::~BaseCarrier() { scene_.world().removeMultiBodyConstraint(constraint_.get()); }

// A step removes the share erp of what the constraint sees as its error: it is shown a frame so far
// ahead that the base arrives.
void BaseCarrier::move_to(const Eigen::Isometry3d& base) {
  const Eigen::Isometry3d now = robot_.frame(link_).pose;
  const double ahead = 1.0 / scene_.world().getSolverInfo().m_erp;
  const Eigen::Vector3d turn =
      prf_core::log_so3(Eigen::Quaterniond(base.linear() * now.linear().transpose()));
  Eigen::Isometry3d shown = Eigen::Isometry3d::Identity();
  shown.linear() = prf_core::exp_so3(ahead * turn).toRotationMatrix() * now.linear();
  shown.translation() = now.translation() + ahead * (base.translation() - now.translation());
  const btTransform frame = to_bullet(shown);
  constraint_->setPivotInB(frame.getOrigin());
  constraint_->setFrameInB(frame.getBasis());
}

}  // namespace platform_sim
