// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "multibody_from_urdf.hpp"

namespace platform_sim {

/// Groups of what may touch what.
enum Group : int { kDeck = 1, kTarget = 2, kBody = 4, kLegs = 8, kUpperArm = 16, kForearm = 32 };
inline constexpr int kSurroundings = kDeck | kTarget;

/// The bodies of a robot: its base, those that the arm's joints move, and legs.
class RobotBodies {
 public:
  /// Throws what v60_gait::rigid_tree_from_urdf() throws.
  RobotBodies(const std::string& urdf_xml, const std::vector<std::string>& arm_joints);

  /// How a body touches others.
  [[nodiscard]] RobotSurface surface(const std::string& body, double friction) const;

 private:
  std::string base_;
  std::map<std::string, std::ptrdiff_t> arm_;  // body: number of the joint that moves it
};

}  // namespace platform_sim
