// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "platform_sim/world.hpp"

namespace platform_sim {

/// Steps a world of arm mode kServo with nobody to command the arm: its servos hold the pose it
/// started in. Calls `sample` now and then `rate` times a second, until `duration` has passed or
/// the robot has fallen. The rate divides 1000 per second.
/// Throws std::invalid_argument with name, value and bound.
void run_headless(World& world, double duration, int rate,
                  const std::function<void(World&)>& sample);

}  // namespace platform_sim
