// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/operator.hpp"

#include <algorithm>
#include <cmath>

namespace v60_gait {
namespace {

constexpr double kLookPeriod = 0.1;  // s
constexpr double kReaction = 0.7;    // s
constexpr double kSmoothing = 0.25;  // weight of a new look, so that the sway is not answered
const Eigen::Vector3d kTolerance(0.03, 0.03, 0.05);  // m, m, rad
const Eigen::Vector3d kGain(0.5, 0.5, 0.4);          // 1/s
const Eigen::Vector3d kFullStick(0.15, 0.10, 0.2);   // m/s, m/s, rad/s

}  // namespace

Eigen::Vector3d Operator::stick(double time, const Eigen::Isometry3d& robot_on_deck) {
  if (looks_.empty() || time >= looks_.back().time + kLookPeriod) {
    const Eigen::Isometry3d error = robot_on_deck.inverse() * place_;
    const double yaw = std::atan2(error.linear()(1, 0), error.linear()(0, 0));
    looks_.push_back({time, {error.translation().x(), error.translation().y(), yaw}});
  }
  while (looks_.size() > 1 && looks_.front().time <= time - kReaction) {
    error_ += kSmoothing * (looks_.front().error - error_);
    looks_.pop_front();
  }
  Eigen::Vector3d stick;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double beyond = std::max(0.0, std::abs(error_[i]) - kTolerance[i]);
    stick[i] = std::copysign(std::min(kGain[i] * beyond, kFullStick[i]), error_[i]);
  }
  return stick;
}

}  // namespace v60_gait
