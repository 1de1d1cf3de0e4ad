// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>

#include "rigid_tree.hpp"

namespace platform_sim {

/// Leg of three rotary joints: toe = O1 R1(q1) O2 R2(q2) O3 R3(q3) toe_in_lower, in base_link.
class LegKinematics {
 public:
  /// Leg with joints <name>_abduction, _hip, _knee and link <name>_toe. Throws
  /// std::invalid_argument if the robot has no such leg on its base.
  LegKinematics(const RigidTree& robot, const std::string& name);

  /// Centre of the toe in base_link, m.
  [[nodiscard]] Eigen::Vector3d toe(const Eigen::Vector3d& angles) const;
  /// d toe / d angles, m/rad.
  [[nodiscard]] Eigen::Matrix3d jacobian(const Eigen::Vector3d& angles) const;
  /// Newton's method from `start`; throws std::invalid_argument if it does not arrive.
  [[nodiscard]] Eigen::Vector3d angles(const Eigen::Vector3d& toe,
                                       const Eigen::Vector3d& start) const;

 private:
  std::string name_;
  std::array<Eigen::Isometry3d, 3> origins_;  // of the joints, in the body before
  std::array<Eigen::Vector3d, 3> axes_;
  Eigen::Vector3d toe_in_lower_;
};

}  // namespace platform_sim
