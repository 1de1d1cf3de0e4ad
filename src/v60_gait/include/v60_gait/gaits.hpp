// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "v60_gait/leg_controller.hpp"
#include "v60_gait/stance.hpp"

namespace v60_gait {

[[nodiscard]] const std::vector<std::string>& gait_names();

/// Throws std::invalid_argument, which lists the gaits, if there is none of that name.
void require_gait(const std::string& name);

/// Controller of a gait for a robot that is in its stance. `friction`: Coulomb coefficient of the
/// feet on the deck, for the friction cones of stand and step. `seed`: of the placing errors of
/// step and of which pair of feet it lifts first. Throws like require_gait().
[[nodiscard]] std::unique_ptr<LegController> make_leg_controller(const std::string& gait,
                                                                 const Stance& stance,
                                                                 const BodyModel& body,
                                                                 double friction,
                                                                 std::uint64_t seed);

}  // namespace v60_gait
