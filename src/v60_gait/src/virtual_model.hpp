// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "feet.hpp"
#include "ground_forces.hpp"
#include "v60_gait/stance.hpp"

namespace v60_gait {

/// Springs and dampers between the body and where it should be.
struct VirtualSprings {
  Eigen::Vector3d way = Eigen::Vector3d::Zero();        ///< 1/s2, acceleration per way: x, y, z
  Eigen::Vector3d way_rate = Eigen::Vector3d::Zero();   ///< 1/s
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();       ///< Nm/rad, about x, y, z
  Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();  ///< Nm s/rad
};

/// How far the body is from where it should be, in axes with z up.
struct BodyError {
  Eigen::Vector3d way = Eigen::Vector3d::Zero();               ///< m, from aim to body
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< m/s, over the deck
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();              ///< rad, from body to aim
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
};

/// Legs carry the body as such springs would (Pratt 2001): the feet's forces come from
/// distribute_wrench() and act through -J^T f, besides the torques that carry the legs themselves.
class VirtualModel {
 public:
  VirtualModel(const Stance& stance, const BodyModel& body, double friction,
               const VirtualSprings& springs);

  /// Torques of the legs on the ground, Nm; of the others only those that carry their weight.
  [[nodiscard]] LegVector torques(const LegObservation& observation, const Feet& feet,
                                  const BodyError& error);

 private:
  [[nodiscard]] Wrench wrench(const BodyError& error) const;

  Stance stance_;
  BodyModel body_;
  double friction_;
  VirtualSprings springs_;
  std::array<Eigen::Vector3d, 4> forces_;  // last ones, where the next search starts
};

/// Rotation vector, rad, that turns `from` into `to`.
[[nodiscard]] Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& from,
                                              const Eigen::Quaterniond& to);

}  // namespace v60_gait
