// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/gaits.hpp"

#include <stdexcept>

#include "stand_controller.hpp"
#include "step_controller.hpp"
#include "v60_gait/stiff_controller.hpp"

namespace v60_gait {

const std::vector<std::string>& gait_names() {
  static const std::vector<std::string> names{"stand", "stand_stiff", "step"};
  return names;
}

void require_gait(const std::string& name) {
  std::string valid;
  for (const std::string& known : gait_names()) {
    if (known == name) return;
    valid += (valid.empty() ? "" : ", ") + known;
  }
  throw std::invalid_argument("gait is '" + name + "', must be one of: " + valid);
}

std::unique_ptr<LegController> make_leg_controller(const std::string& gait, const Stance& stance,
                                                   const BodyModel& body, double friction,
                                                   std::uint64_t seed) {
  require_gait(gait);
  if (gait == "stand_stiff") {
    return std::make_unique<StiffController>(stance.posture, standing_torques(body, stance));
  }
  if (gait == "stand") return std::make_unique<StandController>(stance, body, friction);
  return std::make_unique<StepController>(stance, body, friction, seed);
}

}  // namespace v60_gait
