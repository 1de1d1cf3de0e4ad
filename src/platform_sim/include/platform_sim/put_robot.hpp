// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <prf_robots/robot.hpp>
#include <string>

#include "platform_sim/world_params.hpp"

namespace platform_sim {

/// Puts a robot into the parameters of a world, in its ready posture, and returns it; its `urdf` is
/// the world's description. `name_or_path` as prf_robots::robot_folder() takes it.
/// Throws std::invalid_argument where prf_robots does, and for a camera with another frame than
/// that of the simulated one.
prf_robots::Robot put_robot(const std::string& name_or_path, WorldParams* config);

}  // namespace platform_sim
