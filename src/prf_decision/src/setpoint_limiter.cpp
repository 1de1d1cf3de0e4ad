// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/setpoint_limiter.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>

namespace prf_decision {
namespace {

Eigen::Quaterniond rotated(const Eigen::Quaterniond& orientation, const Eigen::Vector3d& rotation) {
  if (rotation.norm() == 0) return orientation;
  return (Eigen::Quaterniond(prf_core::exp_so3(rotation)) * orientation).normalized();
}

// Velocity that closes the gap within the rule's bounds.
Eigen::Vector3d closing_velocity(const Eigen::Vector3d& gap, double speed, double time_constant,
                                 double seconds) {
  const double distance = gap.norm();
  if (distance == 0 || seconds <= 0) return Eigen::Vector3d::Zero();
  const double fraction = -std::expm1(-seconds / time_constant);
  return gap * std::min(fraction / seconds, speed / distance);
}

}  // namespace

void CatchUpParams::validate() const {
  prf_core::require_between("catch_up_speed linear", linear, 0.01, 1, "m/s");
  prf_core::require_between("catch_up_speed angular", angular, 0.01, 4, "rad/s");
  prf_core::require_between("catch_up_time", time_constant, 0.01, 5, "s");
}

MovingPose limited_setpoint(const Pose& previous, const MovingPose& reference,
                            const CatchUpParams& catch_up, Duration dt) {
  const double seconds = to_seconds(dt);
  MovingPose setpoint = reference;

  const Eigen::Vector3d carried = previous.position + reference.linear_velocity * seconds;
  const Eigen::Vector3d closing = closing_velocity(
      reference.pose.position - carried, catch_up.linear, catch_up.time_constant, seconds);
  setpoint.pose.position = carried + closing * seconds;
  setpoint.linear_velocity += closing;

  const Eigen::Quaterniond turned =
      rotated(previous.orientation, reference.angular_velocity * seconds);
  const Eigen::Vector3d turning =
      closing_velocity(prf_core::rotation_between(turned, reference.pose.orientation),
                       catch_up.angular, catch_up.time_constant, seconds);
  setpoint.pose.orientation = rotated(turned, turning * seconds);
  setpoint.angular_velocity += turning;
  return setpoint;
}

}  // namespace prf_decision
