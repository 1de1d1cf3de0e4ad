// SPDX-License-Identifier: BSD-3-Clause
// A world with the whole robot, for tests.
#pragma once

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "platform_sim/put_robot.hpp"
#include "platform_sim/world.hpp"

namespace platform_sim {

/// The description of a robot of prf_robots; the build gives its place.
inline std::string robot_urdf(const std::string& robot = "jaco_v60") {
  std::ifstream file(ROBOTS_DIR + std::string("/") + robot + "/robot.urdf");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The robot in its ready posture.
inline WorldParams in_world(const std::string& robot) {
  WorldParams params;
  put_robot(ROBOTS_DIR + std::string("/") + robot, &params);
  return params;
}

inline WorldParams folded_arm() {
  WorldParams params = in_world("jaco_v60");
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
