// SPDX-License-Identifier: BSD-3-Clause
#include "jaco_kinematics/jaco_arm.hpp"

#include <limits>

#include "jaco_kinematics/jaco_kinematics.hpp"

namespace jaco_kinematics {

JacoArm::JacoArm() {
  const JointLimits& limits = jaco_joint_limits();
  limits_ = {limits.lower, limits.upper, limits.velocity, limits.effort,
             JointVector::Constant(std::numeric_limits<double>::infinity())};
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
                                          const arm_kinematics::IkSearch& options) const {
  require_joints(seed, "seed");
  IkParams params;
  if (options.nearest) params.limit_weight = 0.0;
  const IkResult found = jaco_kinematics::inverse(pose, seed, params);
  return {
      found.status == IkStatus::kSolved, found.q, {found.position_error, found.orientation_error}};
}

bool JacoArm::reaches(const Eigen::Isometry3d& pose) const {
  return any_inverse(pose).status == IkStatus::kSolved;
}

arm_kinematics::JointVector JacoArm::posture_motion(const arm_kinematics::JointVector& q) const {
  require_joints(q, "q");
  return jaco_kinematics::posture_motion(q);
}

}  // namespace jaco_kinematics
