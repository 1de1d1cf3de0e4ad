// SPDX-License-Identifier: BSD-3-Clause
// The serial chain between two links of a URDF.
#pragma once

#include <string>
#include <vector>

#include "arm_kinematics/arm_kinematics.hpp"

namespace arm_kinematics {

// Joints from base to tip. The frame of each is turned so that its axis is z.
struct ChainJoint {
  std::string name;
  bool prismatic = false;
  Eigen::Isometry3d origin;  // of the joint's frame in the one before, at 0
};

struct Chain {
  std::vector<ChainJoint> joints;  // 5 to 8
  Eigen::Isometry3d tip;           // in the frame of the last joint
  JointLimits limits;
};

// Throws std::invalid_argument, in one line with what is allowed, for text that is no URDF, a link
// that two joints carry (a loop), a link that is not there, a tip that the base does not carry,
// fewer than 5 or more than 8 moving joints, a joint that is floating or planar or that mimics
// another one, and limits that are missing, not finite or upside down. A continuous joint needs a
// velocity limit alone. Shapes and meshes are not read.
[[nodiscard]] Chain chain_from_urdf(const std::string& urdf, const std::string& base,
                                    const std::string& tip);

}  // namespace arm_kinematics
