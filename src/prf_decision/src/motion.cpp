// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/motion.hpp"

#include <algorithm>
#include <stdexcept>

#include "hermite.hpp"

namespace prf_decision {
namespace {

constexpr double kUnitTolerance = 1e-6;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void validate_pose(const Pose& pose, const std::string& name) {
  if (!pose.position.allFinite()) refuse(name + ".position is not finite");
  const double norm = pose.orientation.norm();
  if (!(std::abs(norm - 1) <= kUnitTolerance)) {
    refuse(name + ".orientation has norm " + std::to_string(norm) + ", must be 1");
  }
}

}  // namespace

void Forecast::validate() const {
  const bool acted_on = status == TargetStatus::kTracking || status == TargetStatus::kCoasting;
  if (acted_on && predictions.empty()) refuse("predictions are empty though there is a target");
  if (since_measurement < Duration{0}) refuse("since_measurement is negative");
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    const std::string name = "predictions[" + std::to_string(i) + "]";
    const auto& [horizon, target] = predictions[i];
    if (i == 0 && horizon != Duration{0}) refuse(name + ".horizon must be 0");
    if (i > 0 && horizon <= predictions[i - 1].horizon) refuse(name + ".horizon does not rise");
    validate_pose(target.pose, name);
    if (!target.linear_velocity.allFinite() || !target.angular_velocity.allFinite()) {
      refuse(name + ".twist is not finite");
    }
  }
}

void Trajectory::validate() const {
  if (poses.size() < 2) {
    refuse("poses has " + std::to_string(poses.size()) + " nodes, must have at least 2");
  }
  if (times.size() != poses.size()) {
    refuse("time_from_start has " + std::to_string(times.size()) + " values for " +
           std::to_string(poses.size()) + " poses");
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    validate_pose(poses[i], "poses[" + std::to_string(i) + "]");
    const bool rises = i == 0 ? times[0] == Duration{0} : times[i] > times[i - 1];
    if (!rises) refuse("time_from_start[" + std::to_string(i) + "] does not rise from 0");
  }
  validate_pose(goal_in_target, "goal_in_target");
}

Eigen::Vector3d rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  Eigen::Quaterniond turn = to * from.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double half_sine = turn.vec().norm();
  // The quotient 2 asin(x)/x tends to 2.
  const double scale = half_sine < 1e-9 ? 2.0 : 2.0 * std::atan2(half_sine, turn.w()) / half_sine;
  return scale * turn.vec();
}

MovingPose target_at(const Forecast& forecast, Stamp stamp) {
  const auto& predictions = forecast.predictions;
  if (predictions.empty()) refuse("predictions are empty, must have at least 1");
  const Duration horizon = stamp - forecast.stamp;
  const auto next = std::upper_bound(
      predictions.begin(), predictions.end(), horizon,
      [](Duration value, const Prediction& prediction) { return value < prediction.horizon; });
  if (next == predictions.begin() || next == predictions.end()) {
    const Prediction& nearest = next == predictions.end() ? predictions.back() : predictions[0];
    const bool exact = nearest.horizon == horizon;
    return exact ? nearest.target : MovingPose{nearest.target.pose, {0, 0, 0}, {0, 0, 0}};
  }
  const Prediction& start = *std::prev(next);
  return hermite(start.target, next->target, to_seconds(next->horizon - start.horizon),
                 to_seconds(horizon - start.horizon));
}

MovingPose attached(const MovingPose& carrier, const Pose& frame_in_carrier) {
  const Eigen::Vector3d lever = carrier.pose.orientation * frame_in_carrier.position;
  MovingPose frame;
  frame.pose.position = carrier.pose.position + lever;
  frame.pose.orientation = (carrier.pose.orientation * frame_in_carrier.orientation).normalized();
  frame.linear_velocity = carrier.linear_velocity + carrier.angular_velocity.cross(lever);
  frame.angular_velocity = carrier.angular_velocity;
  return frame;
}

}  // namespace prf_decision
