// SPDX-License-Identifier: BSD-3-Clause
#include "stand_controller.hpp"

namespace platform_sim {
namespace {

constexpr double kStiffness = 600.0;  // Nm/rad
constexpr double kDamping = 30.0;     // Nm s/rad

}  // namespace

StandController::StandController(const LegVector& posture, const LegVector& load)
    : posture_(posture), load_(load) {}

LegVector StandController::torques(const LegObservation& observation) {
  return load_ + kStiffness * (posture_ - observation.positions) -
         kDamping * observation.velocities;
}

}  // namespace platform_sim
