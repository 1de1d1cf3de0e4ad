// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "feet.hpp"
#include "ground_forces.hpp"
#include "v60_gait/stance.hpp"

namespace v60_gait {

/// Springs and dampers between the body and its desired pose.
struct VirtualSprings {
  Eigen::Vector3d position_stiffness =
      Eigen::Vector3d::Zero();  ///< 1/s2, acceleration per m: x, y, z
  Eigen::Vector3d position_damping = Eigen::Vector3d::Zero();    ///< 1/s
  Eigen::Vector3d rotation_stiffness = Eigen::Vector3d::Zero();  ///< Nm/rad, about x, y, z
  Eigen::Vector3d rotation_damping = Eigen::Vector3d::Zero();    ///< Nm s/rad
};

/// The body relative to its desired pose, in axes with z up.
struct BodyError {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();          ///< m, from desired to actual
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< m/s, over the deck
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();          ///< rad, from actual to desired
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
};

/// Virtual model control (Pratt et al. 2001): the springs' wrench on the body is distributed over
/// the feet on the ground by distribute_wrench(). Each foot's force f gives the torques -J^T f; the
/// weight of the legs is added.
class VirtualModel {
 public:
  VirtualModel(const Stance& stance, const BodyModel& body, double friction,
               const VirtualSprings& springs);

  /// Torques, Nm. Legs in the air get those that carry their own weight only.
  [[nodiscard]] LegVector torques(const LegObservation& observation, const Feet& feet,
                                  const BodyError& error);

 private:
  [[nodiscard]] Wrench wrench(const BodyError& error) const;

  Stance stance_;
  BodyModel body_;
  double friction_;
  VirtualSprings springs_;
  std::array<Eigen::Vector3d, 4> forces_;  // N, of the last call: start of the next search
};

}  // namespace v60_gait
