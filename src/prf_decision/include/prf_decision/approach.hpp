// SPDX-License-Identifier: BSD-3-Clause
// The approach is the last part of the skill, executed relative to the target. The hand reaches the
// target along the planned line, however the target has moved since a node was planned. While the
// execution pauses the hand stands still relative to the target.
//
// Node k of a plan has the pose p_k, made for the target predicted at the node's own time, T_k. Its
// anchor is that pose in the target's frame, a_k = T_k^-1 p_k. A node that later plans leave where
// it is (it is frozen) keeps its anchor. Let T be the target now, p and a plan and anchors at the
// cursor, d the straight distance of a from the plan's goal_in_target, and D the length of the
// approach. The hand is at
//   (1 - w) p + w T a,   w = 3 s^2 - 2 s^3,   s = 2 - d / D clamped to 0 .. 1
// so that w = 1 for d <= D and w = 0 for d >= 2 D.
#pragma once

#include "prf_decision/execution_cursor.hpp"

namespace prf_decision {

class Approach {
 public:
  // Takes a plan that was made from `forecast` for an execution that was at `cursor` at `stamp`.
  void update(const Trajectory& plan, double cursor, Stamp stamp, const TargetForecast& forecast);

  // w at the cursor, 0 .. 1; 0 without a plan. `length` is D in m; 0: no approach, w = 0.
  [[nodiscard]] double weight(double cursor, double length) const;

  // Hand at the cursor for the target as it is. The velocity is that of the target's motion plus
  // that along the plan, executed in `direction`. Needs a plan.
  [[nodiscard]] MovingPose hand(double cursor, Direction direction, const MovingPose& target,
                                double length) const;

 private:
  Trajectory plan_;
  Trajectory anchors_;  // the same nodes in the target's frame
};

}  // namespace prf_decision
