// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/setpoint_limiter.hpp"

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

}  // namespace

void CatchUpSpeed::validate() const {
  require_positive(linear, "catch_up_speed linear");
  require_positive(angular, "catch_up_speed angular");
}

MovingPose limited_setpoint(const Pose& previous, const MovingPose& reference,
                            const CatchUpSpeed& speed, Duration dt) {
  const double seconds = to_seconds(dt);
  MovingPose setpoint = reference;

  const Eigen::Vector3d carried = previous.position + reference.linear_velocity * seconds;
  const Eigen::Vector3d gap = reference.pose.position - carried;
  if (gap.norm() > speed.linear * seconds) {
    const Eigen::Vector3d closing = gap.normalized() * speed.linear;
    setpoint.pose.position = carried + closing * seconds;
    setpoint.linear_velocity += closing;
  }

  const Eigen::Quaterniond turned =
      rotated(previous.orientation, reference.angular_velocity * seconds);
  const Eigen::Vector3d turn = rotation_between(turned, reference.pose.orientation);
  if (turn.norm() > speed.angular * seconds) {
    const Eigen::Vector3d closing = turn.normalized() * speed.angular;
    setpoint.pose.orientation = rotated(turned, closing * seconds);
    setpoint.angular_velocity += closing;
  }
  return setpoint;
}

}  // namespace prf_decision
