// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/se3.hpp"

#include <cmath>

#include "prf_core/bounds.hpp"
#include "prf_core/require.hpp"

namespace prf_core {
namespace {

// Below this sine of the half angle, Log is 2 vec to the last bit and its quotient is undefined.
constexpr double kSmallHalfSine = 1e-9;

}  // namespace

Eigen::Isometry3d Pose::isometry() const {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = orientation.toRotationMatrix();
  result.translation() = position;
  return result;
}

Pose pose_from(const Eigen::Isometry3d& isometry) {
  return {isometry.translation(), Eigen::Quaterniond(isometry.linear()).normalized()};
}

void require_pose(const std::string& name, const Pose& pose) {
  require_within(name + ".position", pose.position, kMaxPosition, "m");
  const double norm = pose.orientation.norm();
  require(std::abs(norm - 1.0) <= kUnitQuaternionTolerance, name + ".orientation's norm", norm,
          "1 within 0.001");
}

Eigen::Vector3d log_so3(const Eigen::Quaterniond& rotation) {
  // q and -q are the same rotation; the one with w >= 0 has the angle in [0, pi].
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const double half_sine = rotation.vec().norm();
  const double scale = half_sine < kSmallHalfSine
                           ? 2.0
                           : 2.0 * std::atan2(half_sine, sign * rotation.w()) / half_sine;
  return sign * scale * rotation.vec();
}

Eigen::AngleAxisd exp_so3(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0.0) return Eigen::AngleAxisd::Identity();
  return {angle, rotation_vector / angle};
}

Eigen::Vector3d rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  return log_so3(to * from.conjugate());
}

MovingPose rigidly_attached(const MovingPose& carrier, const Pose& frame_in_carrier) {
  const Eigen::Vector3d lever = carrier.pose.orientation * frame_in_carrier.position;
  MovingPose frame;
  frame.pose.position = carrier.pose.position + lever;
  frame.pose.orientation = (carrier.pose.orientation * frame_in_carrier.orientation).normalized();
  frame.linear_velocity = carrier.linear_velocity + carrier.angular_velocity.cross(lever);
  frame.angular_velocity = carrier.angular_velocity;
  return frame;
}

MovingPose interpolate(const MovingPose& start, const MovingPose& end, double span, double time) {
  const double s = time / span;
  const Eigen::Vector3d p0 = start.pose.position;
  const Eigen::Vector3d p1 = end.pose.position;
  const Eigen::Vector3d m0 = start.linear_velocity * span;
  const Eigen::Vector3d m1 = end.linear_velocity * span;
  MovingPose at;
  at.pose.position =
      p0 + s * m0 + s * s * (3 * (p1 - p0) - 2 * m0 - m1) + s * s * s * (2 * (p0 - p1) + m0 + m1);
  at.linear_velocity =
      (m0 + 2 * s * (3 * (p1 - p0) - 2 * m0 - m1) + 3 * s * s * (2 * (p0 - p1) + m0 + m1)) / span;
  at.pose.orientation = start.pose.orientation.slerp(s, end.pose.orientation);
  at.angular_velocity = rotation_between(start.pose.orientation, end.pose.orientation) / span;
  return at;
}

}  // namespace prf_core
