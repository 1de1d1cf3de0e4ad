// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "platform_sim/world.hpp"

namespace platform_sim {

/// Steps a world without commands to the arm: in arm mode kServo the servos hold the pose that the
/// arm started in. Calls `sample` once at the beginning and after that `rate` times a second, until
/// `duration` has passed or the robot has fallen. `rate` must divide 1000; `duration` is in s.
/// Throws std::invalid_argument with name, value and bound.
void run_headless(World& world, double duration, int rate,
                  const std::function<void(World&)>& sample);

}  // namespace platform_sim
