// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/stiff_controller.hpp"

namespace v60_gait {
namespace {

// Stiff enough that the body follows the deck; about critically damped.
constexpr double kStiffness = 600.0;  // Nm/rad
constexpr double kDamping = 30.0;     // Nm s/rad

}  // namespace

StiffController::StiffController(const LegVector& posture, const LegVector& load)
    : posture_(posture), load_(load) {}

LegVector StiffController::torques(const LegObservation& observation) {
  return load_ + kStiffness * (posture_ - observation.positions) -
         kDamping * observation.velocities;
}

}  // namespace v60_gait
