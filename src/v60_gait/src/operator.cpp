// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/operator.hpp"

#include <algorithm>
#include <cmath>

namespace v60_gait {
namespace {

// Chosen by hand, for a person who watches the robot from beside the treadmill.
constexpr double kObservationPeriod = 0.1;  // s
constexpr double kReactionTime = 0.7;       // s
constexpr double kSmoothingWeight = 0.25;  // of a new observation, so that the sway is not followed
const Eigen::Vector3d kTolerance(0.03, 0.03, 0.05);      // m, m, rad
const Eigen::Vector3d kGain(0.5, 0.5, 0.4);              // 1/s
const Eigen::Vector3d kLargestCommand(0.15, 0.10, 0.2);  // m/s, m/s, rad/s

}  // namespace

Eigen::Vector3d Operator::joystick(double time, const Eigen::Isometry3d& robot_on_deck) {
  if (pending_.empty() || time >= pending_.back().time + kObservationPeriod) {
    const Eigen::Isometry3d error = robot_on_deck.inverse() * place_;
    const double yaw = std::atan2(error.linear()(1, 0), error.linear()(0, 0));
    pending_.push_back({time, {error.translation().x(), error.translation().y(), yaw}});
  }
  while (pending_.size() > 1 && pending_.front().time <= time - kReactionTime) {
    error_ += kSmoothingWeight * (pending_.front().error - error_);
    pending_.pop_front();
  }
  Eigen::Vector3d joystick;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double beyond = std::max(0.0, std::abs(error_[i]) - kTolerance[i]);
    joystick[i] = std::copysign(std::min(kGain[i] * beyond, kLargestCommand[i]), error_[i]);
  }
  return joystick;
}

}  // namespace v60_gait
