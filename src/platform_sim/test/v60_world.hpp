// SPDX-License-Identifier: BSD-3-Clause
// A world with the whole robot, for tests.
#pragma once

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "platform_sim/world.hpp"

namespace platform_sim {

/// The description of the robot; the build gives its place.
inline std::string robot_urdf() {
  std::ifstream file(ROBOT_URDF_FILE);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline WorldParams folded_arm() {
  WorldParams params;
  params.arm_start << 3.14, 2.3, 0.0, 1.5, 0.0, 3.4, 0.0;
  return params;
}

inline void run(World& world, double duration) {
  const auto steps = std::lround(duration / World::kTimeStep);
  for (long step = 0; step < steps; ++step) world.step();
}

inline Eigen::Vector3d in_platform(const World& world, const std::string& link) {
  return world.platform().pose.inverse() * world.frame(link).pose.translation();
}

}  // namespace platform_sim
