// SPDX-License-Identifier: BSD-3-Clause
// Executes the last part of the skill, the approach, relative to the target: the hand enters the
// box along the planned line however the box has moved since a node was planned, and stands still
// relative to the box while the execution pauses.
//
// Node k of a plan has the pose p_k, made for the target predicted at the node's own time, T_k. Its
// anchor is that pose in the target's frame, a_k = T_k^-1 p_k. A node that later plans leave where
// it is (it is frozen) keeps its anchor. With T the target now, d the distance of a from the end of
// the skill, and D the length of the approach, the hand is at
//   (1 - w) p + w T a,   w = 1 for d <= D, falling to 0 at d = 2 D as 3 s^2 - 2 s^3.
#pragma once

#include "prf_decision/execution_cursor.hpp"

namespace prf_decision {

class Approach {
 public:
  // A plan made for an execution that was at `cursor` at `stamp`.
  void update(const Trajectory& plan, double cursor, Stamp stamp, const TargetForecast& forecast);

  // w at the cursor, 0 .. 1; 0 without a plan.
  [[nodiscard]] double weight(double cursor, double length) const;

  // Hand at the cursor for the target as it is; velocities as executed in `direction`. Needs a
  // plan.
  [[nodiscard]] MovingPose hand(double cursor, Direction direction, const MovingPose& target,
                                double length) const;

 private:
  Trajectory plan_;
  Trajectory anchors_;  // the same nodes in the target's frame
};

}  // namespace prf_decision
