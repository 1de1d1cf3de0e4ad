// SPDX-License-Identifier: BSD-3-Clause
// The closed form of jaco_kinematics.hpp as one arm among others.
#pragma once

#include <arm_kinematics/arm_kinematics.hpp>

namespace jaco_kinematics {

class JacoArm : public arm_kinematics::ArmKinematics {
 public:
  JacoArm();

  [[nodiscard]] const arm_kinematics::JointLimits& limits() const override { return limits_; }
  [[nodiscard]] Eigen::Isometry3d forward(const arm_kinematics::JointVector& q) const override;
  [[nodiscard]] arm_kinematics::Placement placement(
      const arm_kinematics::JointVector& q) const override;
  // The solution of least cost (IkParams); nothing is drawn.
  [[nodiscard]] arm_kinematics::IkResult inverse(
      const Eigen::Isometry3d& pose, const arm_kinematics::JointVector& seed,
      const arm_kinematics::IkSearch& options = {}) const override;
  [[nodiscard]] bool reaches(const Eigen::Isometry3d& pose) const override;
  // To the preferred arm angle, away from the limits of joints 2 and 6.
  [[nodiscard]] arm_kinematics::JointVector posture_motion(
      const arm_kinematics::JointVector& q) const override;

 private:
  arm_kinematics::JointLimits limits_;
};

}  // namespace jaco_kinematics
