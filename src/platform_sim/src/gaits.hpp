// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "multibody_from_urdf.hpp"
#include "platform_sim/leg_controller.hpp"
#include "stance.hpp"

namespace platform_sim {

[[nodiscard]] const std::vector<std::string>& gait_names();

/// Throws std::invalid_argument, which lists the gaits, if there is none of that name.
void require_gait(const std::string& name);

/// Controller of a gait for a robot that is in its stance. `seed`: of what it does at random.
[[nodiscard]] std::unique_ptr<LegController> make_leg_controller(const std::string& gait,
                                                                 const RobotModel& robot,
                                                                 const Stance& stance,
                                                                 double friction,
                                                                 std::uint64_t seed);

}  // namespace platform_sim
