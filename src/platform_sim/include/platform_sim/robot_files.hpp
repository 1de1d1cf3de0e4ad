// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "platform_sim/world.hpp"

namespace platform_sim {

/// Robot description of the package jaco_v60_description, looked for in the sourced workspaces
/// (CMAKE_PREFIX_PATH).
/// Throws std::runtime_error if there is none.
[[nodiscard]] std::string installed_robot_description();

/// The pose of the arm in which the simulator starts: initial_positions of its configuration.
/// Throws std::runtime_error if it cannot be read.
[[nodiscard]] ArmVector configured_arm_start();

}  // namespace platform_sim
