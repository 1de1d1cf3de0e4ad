// SPDX-License-Identifier: BSD-3-Clause
// What the arm shall do at one tick. checked_setpoint() is the one place where it is checked.
#pragma once

#include <Eigen/Core>
#include <string>

#include "prf_control/setpoint_follower.hpp"

namespace prf_control {

enum class SetpointKind { kPose, kHold, kInvalid };

struct Setpoint {
  SetpointKind kind = SetpointKind::kHold;
  PoseSetpoint pose;    // meaningful for kPose
  std::string refusal;  // why, for kInvalid
};

[[nodiscard]] Setpoint hold_setpoint();
[[nodiscard]] Setpoint refused_setpoint(const std::string& reason);

// kPose, or kInvalid when a number is not finite or beyond any arm (1 km, 1 km/s, 1000 rad/s), or
// the quaternion (x, y, z, w) is not of unit length within 1 %; within that it is normalised.
// prf_core is stricter (1e-3).
[[nodiscard]] Setpoint checked_setpoint(const Eigen::Vector3d& position,
                                        const Eigen::Vector4d& quaternion,
                                        const Eigen::Vector3d& linear_velocity,
                                        const Eigen::Vector3d& angular_velocity);

}  // namespace prf_control
