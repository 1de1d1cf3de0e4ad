// SPDX-License-Identifier: BSD-3-Clause
#include "jaco_kinematics/jaco_arm.hpp"

#include "jaco_kinematics/jaco_kinematics.hpp"

namespace jaco_kinematics {

JacoArm::JacoArm() {
  const JointLimits& limits = jaco_joint_limits();
  limits_ = {limits.lower, limits.upper, limits.velocity, limits.effort};
}

Eigen::Isometry3d JacoArm::forward(const arm_kinematics::JointVector& q) const {
  require_joints(q, "q");
  return jaco_kinematics::forward(q);
}

arm_kinematics::Placement JacoArm::placement(const arm_kinematics::JointVector& q) const {
  require_joints(q, "q");
  return {jaco_kinematics::forward(q), jaco_kinematics::jacobian(q)};
}

arm_kinematics::IkResult JacoArm::inverse(const Eigen::Isometry3d& pose,
                                          const arm_kinematics::JointVector& seed,
                                          std::uint64_t /*draws*/) const {
  require_joints(seed, "seed");
  const IkResult found = jaco_kinematics::inverse(pose, seed);
  return {
      found.status == IkStatus::kSolved, found.q, {found.position_error, found.orientation_error}};
}

}  // namespace jaco_kinematics
