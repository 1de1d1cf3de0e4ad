// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/setpoint.hpp"

#include <cmath>
#include <sstream>

namespace prf_control {
namespace {

constexpr double kLargest = 1e3;         // m, m/s, rad/s: beyond any arm
constexpr double kUnitTolerance = 0.01;  // of the quaternion's length

std::string refusal_of(const char* name, const Eigen::Vector3d& value) {
  if (value.allFinite() && value.cwiseAbs().maxCoeff() <= kLargest) return "";
  std::ostringstream text;
  text << name << " (" << value.transpose() << ") must be finite and within " << kLargest;
  return text.str();
}

}  // namespace

Setpoint hold_setpoint() { return {}; }

Setpoint refused_setpoint(const std::string& reason) {
  Setpoint setpoint;
  setpoint.kind = SetpointKind::kInvalid;
  setpoint.refusal = reason;
  return setpoint;
}

Setpoint checked_setpoint(const Eigen::Vector3d& position, const Eigen::Vector4d& quaternion,
                          const Eigen::Vector3d& linear_velocity,
                          const Eigen::Vector3d& angular_velocity) {
  for (const std::string& reason :
       {refusal_of("position", position), refusal_of("linear velocity", linear_velocity),
        refusal_of("angular velocity", angular_velocity)}) {
    if (!reason.empty()) return refused_setpoint(reason);
  }
  const double length = quaternion.norm();
  if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
    std::ostringstream text;
    text << "quaternion length " << length << " must be 1 within " << kUnitTolerance;
    return refused_setpoint(text.str());
  }
  Setpoint setpoint;
  setpoint.kind = SetpointKind::kPose;
  setpoint.pose.hand_in_base.translation() = position;
  setpoint.pose.hand_in_base.linear() =
      Eigen::Quaterniond(Eigen::Vector4d(quaternion / length)).toRotationMatrix();
  setpoint.pose.linear_velocity = linear_velocity;
  setpoint.pose.angular_velocity = angular_velocity;
  return setpoint;
}

}  // namespace prf_control
