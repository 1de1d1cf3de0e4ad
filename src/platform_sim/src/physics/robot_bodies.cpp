// SPDX-License-Identifier: BSD-3-Clause
#include "robot_bodies.hpp"

#include <algorithm>

#include "v60_gait/rigid_tree.hpp"

namespace platform_sim {
namespace {

// A stiff contact with damping: Bullet's rigid one creeps. A leg that carries a quarter of the
// robot sinks in by 1.4 mm; the damping is about critical for its share of the mass.
constexpr double kFootStiffness = 1e5;  // N/m
constexpr double kFootDamping = 3e3;    // N s/m
// Chosen by hand: softer, because the links of the arm are light.
constexpr double kArmStiffness = 2e4;  // N/m
constexpr double kArmDamping = 2e2;    // N s/m

}  // namespace

RobotBodies::RobotBodies(const std::string& urdf_xml, const std::vector<std::string>& arm_joints) {
  const v60_gait::RigidTree tree = v60_gait::rigid_tree_from_urdf(urdf_xml, false);
  base_ = tree.bodies.front().name;
  for (const v60_gait::RobotJoint& joint : tree.joints) {
    const auto found = std::find(arm_joints.begin(), arm_joints.end(), joint.name);
    if (found == arm_joints.end()) continue;
    arm_[tree.bodies[static_cast<std::size_t>(joint.body)].name] = found - arm_joints.begin();
  }
}

// The third body of the arm and those after it can reach base and legs, the ones before are always
// close to the base.
RobotSurface RobotBodies::surface(const std::string& body, double friction) const {
  if (const auto found = arm_.find(body); found != arm_.end()) {
    const bool is_forearm = found->second >= 2;
    const CollisionFilter filter = is_forearm
                                       ? CollisionFilter{kForearm, kSurroundings | kBody | kLegs}
                                       : CollisionFilter{kUpperArm, kSurroundings};
    return {"", filter, friction, kArmStiffness, kArmDamping};
  }
  if (body == base_) {
    return {"body", {kBody, kSurroundings | kForearm}, friction, kFootStiffness, kFootDamping};
  }
  return {"", {kLegs, kSurroundings | kForearm}, friction, kFootStiffness, kFootDamping};
}

}  // namespace platform_sim
