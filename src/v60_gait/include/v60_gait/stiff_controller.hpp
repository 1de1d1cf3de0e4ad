// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "v60_gait/leg_controller.hpp"

namespace v60_gait {

/// Stands by holding a posture stiffly: tau = tau_load + kp (q_stand - q) - kd dq, with
/// kp = 600 Nm/rad and kd = 30 Nm s/rad, chosen by hand.
class StiffController : public LegController {
 public:
  /// `load`: torques that carry the robot at rest in that posture, Nm.
  StiffController(const LegVector& posture, const LegVector& load);

  [[nodiscard]] LegVector torques(const LegObservation& observation) override;

 private:
  LegVector posture_;
  LegVector load_;
};

}  // namespace v60_gait
