// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/measured_joints.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace prf_control {
namespace {

constexpr double kTurn = 2.0 * M_PI;

// The angle equal to `angle` but for turns that is nearest to `place`. An angle less than half a
// turn from it stays as it is, bit by bit.
double nearest_turn(double angle, double place) {
  return angle - kTurn * std::round((angle - place) / kTurn);
}

double unwrapped_limited(double angle, double lower, double upper,
                         const std::optional<double>& command) {
  if (angle >= lower && angle <= upper) return angle;
  const double inside = nearest_turn(angle, 0.5 * (lower + upper));  // if any turn is
  if (inside >= lower && inside <= upper) return inside;
  return command ? nearest_turn(angle, *command) : inside;
}

}  // namespace

JointSample checked_joints(prf_core::Stamp stamp, const JointVector& position,
                           const std::vector<std::string>& names) {
  JointSample sample;
  sample.stamp = stamp;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double angle = position[static_cast<Eigen::Index>(i)];
    if (std::abs(angle) <= kLargestAngle) continue;
    std::ostringstream text;
    text << "joint_states: position of " << names[i] << " is " << angle
         << " rad, must be finite and within " << kLargestAngle << " rad";
    sample.fault = text.str();
    return sample;
  }
  sample.position = position;
  return sample;
}

JointVector unwrapped(const JointVector& reported, const std::optional<JointVector>& last_command) {
  const auto& limits = jaco_kinematics::jaco_joint_limits();
  JointVector result = reported;
  for (int i = 0; i < result.size(); ++i) {
    std::optional<double> command;
    if (last_command) command = (*last_command)[i];
    if (std::isfinite(limits.lower[i])) {
      result[i] = unwrapped_limited(reported[i], limits.lower[i], limits.upper[i], command);
    } else if (command) {
      result[i] = nearest_turn(reported[i], *command);
    }
  }
  return result;
}

JointVector joints_outside(const JointVector& position) {
  const auto& limits = jaco_kinematics::jaco_joint_limits();
  return (limits.lower - position).cwiseMax(position - limits.upper).cwiseMax(0.0);
}

}  // namespace prf_control
