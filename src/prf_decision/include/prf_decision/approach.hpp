// SPDX-License-Identifier: BSD-3-Clause
// The last part of the skill belongs to the target rather than to the robot: the hand enters the
// box along the planned line whatever the box has done since a node was planned, and stands still
// with respect to the box while the execution pauses.
//
// Node k of a plan p was made for where the target is forecast to be at the node's own time, T_k;
// its anchor is a_k = T_k^-1 p_k. A node that later plans leave where it is (it is being executed)
// keeps its anchor. With T the target now, d the distance of a from the end of the skill, and D the
// approach's length, the hand is at
//   (1 - w) p + w T a,   w = 1 for d <= D, falling to 0 at d = 2 D as 3 s^2 - 2 s^3.
#pragma once

#include "prf_decision/execution_cursor.hpp"

namespace prf_decision {

class Approach {
 public:
  // Takes a plan made for an execution that was at `cursor` at `stamp`.
  void take(const Trajectory& plan, double cursor, Stamp stamp, const TargetForecast& forecast);

  // 0 .. 1: the target's share w at the cursor; 0 before a plan was taken.
  [[nodiscard]] double share(double cursor, double length) const;

  // Hand at the cursor for the target as it is; velocities as executed in `direction`.
  // A plan must have been taken.
  [[nodiscard]] MovingPose hand(double cursor, Direction direction, const MovingPose& target,
                                double length) const;

 private:
  Trajectory plan_;
  Trajectory anchors_;  // the same nodes in the target's frame
};

}  // namespace prf_decision
