// SPDX-License-Identifier: BSD-3-Clause
#include "gaits.hpp"

#include <stdexcept>

#include "gravity.hpp"
#include "stand_controller.hpp"
#include "step_controller.hpp"
#include "stiff_controller.hpp"

namespace platform_sim {

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

std::unique_ptr<LegController> make_leg_controller(const std::string& gait, const RobotModel& robot,
                                                   const Stance& stance, double friction,
                                                   std::uint64_t seed) {
  require_gait(gait);
  BodyModel body;
  body.weight = robot.mass() * kGravity;
  body.centre_of_mass_in_base = robot.frame("base_link").pose.inverse() * robot.centre_of_mass();
  if (gait == "stand_stiff") {
    return std::make_unique<StiffController>(stance.posture, standing_torques(body, stance));
  }
  if (gait == "stand") return std::make_unique<StandController>(stance, body, friction);
  return std::make_unique<StepController>(stance, body, friction, seed);
}

}  // namespace platform_sim
