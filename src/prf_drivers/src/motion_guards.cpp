// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/motion_guards.hpp"

#include <prf_core/require.hpp>

namespace prf_drivers {

bool GuardsParams::needs_urdf() const {
  return self_collision || joint_bounds || !workspace.empty() || !forbidden.empty();
}

MotionGuards::MotionGuards(const GuardsParams& params)
    : start_(params.start, params.joints), effort_(params.effort, params.joints) {
  params.clearance.validate();
  const std::vector<Box> workspace = boxes_from("workspace", params.workspace);
  const std::vector<Box> forbidden = boxes_from("forbidden", params.forbidden);
  prf_core::require(workspace.size() <= 1, "workspace", workspace.size(), "one box, or none");
  if (params.joint_bounds) {
    range_.emplace(joint_range(params.urdf, params.joints), params.joints);
  }
  if (params.self_collision) {
    prf_core::require(params.start.ready.size() > 0, "ready", "[]",
                      "a posture: self_collision takes from it what may touch");
    self_.emplace(RobotShapes(params.urdf, params.base_link, params.joints), params.start.ready,
                  params.clearance);
  }
  if (!workspace.empty() || !forbidden.empty()) {
    boxes_.emplace(RobotShapes(params.urdf, params.base_link, params.joints),
                   workspace.empty() ? std::nullopt : std::optional(workspace.front()), forbidden,
                   params.clearance);
  }
}

Allowance MotionGuards::allow(const Intended& intended) {
  // Before the costlier ones.
  Allowance slowest;
  const auto holds = [&slowest](const Allowance& found) {
    if (found.hold || found.speed < slowest.speed) slowest = found;
    return found.hold;
  };
  if (holds(effort_.allow(intended)) || holds(start_.allow(intended))) return slowest;
  if (range_ && holds(range_->allow(intended))) return slowest;
  if (self_ && holds(self_->allow(intended))) return slowest;
  if (boxes_ && holds(boxes_->allow(intended))) return slowest;
  return slowest;
}

void MotionGuards::reset() {
  start_.reset();
  effort_.reset();
}

std::vector<std::string> MotionGuards::ignored() const {
  return self_ ? self_->ignored() : std::vector<std::string>();
}

}  // namespace prf_drivers
