// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "bullet_scene.hpp"
#include "multibody_from_urdf.hpp"

namespace platform_sim {

/// Takes the base of a floating robot along a given motion, whatever it costs: a constraint of six
/// rows ties it to a frame in world, so that the arm feels the base's acceleration as on legs.
class BaseCarrier {
 public:
  /// Of the robot's first link.
  BaseCarrier(BulletScene& scene, RobotModel& robot);
  ~BaseCarrier();
  BaseCarrier(const BaseCarrier&) = delete;
  BaseCarrier& operator=(const BaseCarrier&) = delete;

  /// Pose of the base at the end of the coming step, in world.
  void move_to(const Eigen::Isometry3d& base);

 private:
  BulletScene& scene_;
  RobotModel& robot_;
  std::string link_;
  std::unique_ptr<btMultiBodyFixedConstraint> constraint_;
};

}  // namespace platform_sim
