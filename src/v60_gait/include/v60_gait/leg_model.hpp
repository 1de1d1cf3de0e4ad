// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>

#include "v60_gait/rigid_tree.hpp"

namespace v60_gait {

/// Leg of three rotary joints: toe = O1 R1(q1) O2 R2(q2) O3 R3(q3) toe_in_lower, in base_link.
/// Oi: pose of the i-th joint's frame in the segment before; Ri: turn about its axis.
class LegModel {
 public:
  /// Leg with joints <name>_abduction, _hip, _knee and link <name>_toe. Throws
  /// std::invalid_argument if the robot has no such leg on its base.
  LegModel(const RigidTree& robot, const std::string& name);

  /// Centre of the toe in base_link, m.
  [[nodiscard]] Eigen::Vector3d toe(const Eigen::Vector3d& angles) const;
  /// d toe / d angles, m/rad.
  [[nodiscard]] Eigen::Matrix3d jacobian(const Eigen::Vector3d& angles) const;
  /// Torques, Nm, that carry the leg's own mass at rest with the toe free; `gravity` in base_link,
  /// m/s2.
  [[nodiscard]] Eigen::Vector3d weight_torques(const Eigen::Vector3d& angles,
                                               const Eigen::Vector3d& gravity) const;
  /// Joint angles, rad, that bring the toe to `toe`, by Newton's method from `start`. Throws
  /// std::invalid_argument if the iteration does not converge, as for a toe out of reach.
  [[nodiscard]] Eigen::Vector3d angles(const Eigen::Vector3d& toe,
                                       const Eigen::Vector3d& start) const;

 private:
  std::string name_;
  struct Segment {
    Eigen::Isometry3d joint;  // origin in the segment before
    Eigen::Vector3d axis;
    double mass = 0.0;
    Eigen::Vector3d centre_of_mass;
  };
  [[nodiscard]] std::array<Eigen::Isometry3d, 3> segment_poses(const Eigen::Vector3d& angles) const;

  std::array<Segment, 3> segments_;
  Eigen::Vector3d toe_in_lower_;
};

}  // namespace v60_gait
