// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/following_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>

#include "sentence.hpp"

namespace prf_decision {
namespace {

std::string trouble_of(const FollowingParams& params, const FollowingInput& input,
                       const std::optional<PoseError>& error) {
  if (!input.hand) return "the measured hand is unknown";
  if (input.controller_silent) {
    return input.report ? sentence("control/status silent for ",
                                   to_seconds(input.stamp - input.report->stamp), " s")
                        : "control/status silent";
  }
  if (input.report && input.report->failing) {
    return "the arm controller does not follow: " + input.report->reason;
  }
  if (!error || error->is_within(params.path)) return "";
  return sentence("hand ", error->position, " m and ", error->rotation,
                  " rad from its set-point, limits ", params.path.position, " m and ",
                  params.path.rotation, " rad");
}

}  // namespace

void PoseTolerance::validate(const std::string& name) const {
  prf_core::require_between(name + "[0]", position, 1e-3, 1.0, "m");
  prf_core::require_between(name + "[1]", rotation, 1e-3, M_PI, "rad");
}

void FollowingParams::validate() const {
  path.validate("following_tolerance");
  goal.validate("goal_tolerance");
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::string name = "following_limits[" + std::to_string(i) + "]";
    prf_core::require_between(name, to_seconds(limits[i]), 0.01, 60.0, "s");
    prf_core::require(i == 0 || limits[i] > limits[i - 1], name, to_seconds(limits[i]),
                      "greater than the one before");
  }
}

PoseError error_between(const Pose& a, const Pose& b) {
  return {(a.position - b.position).norm(), a.orientation.angularDistance(b.orientation)};
}

void FollowingMonitor::update(const FollowingParams& params, const FollowingInput& input) {
  error_.reset();
  if (input.hand && input.setpoint) error_ = error_between(*input.hand, *input.setpoint);
  const std::string trouble = trouble_of(params, input, error_);
  on_goal_ = trouble.empty() && error_ && error_->is_within(params.goal);
  off_.update(input.stamp, !trouble.empty(), params.limits[0]);
  if (!trouble.empty() || !off_.is_on()) trouble_ = trouble;
  const Duration passed = input.stamp - updated_.value_or(input.stamp);
  updated_ = input.stamp;
  const Duration changed = off_in_all_ + (is_off() ? passed : -passed / kForgiven);
  off_in_all_ = input.is_moved ? std::max(changed, Duration{0}) : Duration{0};
}

}  // namespace prf_decision
