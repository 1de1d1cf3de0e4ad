// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/measured_joints.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace prf_control {
namespace {

constexpr double kTurn = 2.0 * M_PI;

// The angle equal to `angle` but for turns that is nearest to `place`.
double nearest_turn(double angle, double place) {
  return angle - kTurn * std::round((angle - place) / kTurn);
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

JointVector unwrapped(const JointVector& reported, const JointLimits& limits) {
  JointVector result = reported;
  for (int i = 0; i < result.size(); ++i) {
    const double q = reported[i];
    const bool inside = q >= limits.lower[i] && q <= limits.upper[i];
    if (!inside) result[i] = nearest_turn(q, 0.5 * (limits.lower[i] + limits.upper[i]));
  }
  return result;
}

JointVector turns_between(const JointVector& command, const JointVector& measured,
                          const JointLimits& limits) {
  JointVector turns = JointVector::Zero(command.size());
  for (int i = 0; i < turns.size(); ++i) {
    const bool continuous = std::isinf(limits.upper[i]);
    if (continuous) turns[i] = kTurn * std::round((measured[i] - command[i]) / kTurn);
  }
  return turns;
}

JointVector joints_outside(const JointVector& position, const JointLimits& limits) {
  return (limits.lower - position).cwiseMax(position - limits.upper).cwiseMax(0.0);
}

}  // namespace prf_control
