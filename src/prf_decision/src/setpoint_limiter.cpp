// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/setpoint_limiter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace prf_decision {
namespace {

void require_positive(double value, const char* name) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
                                ", must be > 0");
  }
}

Eigen::Quaterniond rotated(const Eigen::Quaterniond& orientation, const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle == 0) return orientation;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, rotation / angle));
  return (turn * orientation).normalized();
}

// Velocity that closes the gap within the rule's bounds.
Eigen::Vector3d closing_velocity(const Eigen::Vector3d& gap, double speed, double time_constant,
                                 double seconds) {
  const double distance = gap.norm();
  if (distance == 0 || seconds <= 0) return Eigen::Vector3d::Zero();
  const double share = -std::expm1(-seconds / time_constant);
  return gap * std::min(share / seconds, speed / distance);
}

}  // namespace

void CatchUp::validate() const {
  require_positive(linear, "catch_up_speed linear");
  require_positive(angular, "catch_up_speed angular");
  require_positive(time_constant, "catch_up_time");
}

MovingPose limited_setpoint(const Pose& previous, const MovingPose& reference,
                            const CatchUp& catch_up, Duration dt) {
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
      closing_velocity(rotation_between(turned, reference.pose.orientation), catch_up.angular,
                       catch_up.time_constant, seconds);
  setpoint.pose.orientation = rotated(turned, turning * seconds);
  setpoint.angular_velocity += turning;
  return setpoint;
}

}  // namespace prf_decision
