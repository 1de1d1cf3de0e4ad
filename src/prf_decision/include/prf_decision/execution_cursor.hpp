// SPDX-License-Identifier: BSD-3-Clause
// Where the execution stands along the planned skill, and the hand's pose there.
//
// The cursor c counts nodes, 0 <= c <= n-1; it moves along the nominal times of the nodes. The
// segment being executed ends at node floor(c)+1, so the first floor(c)+2 nodes are frozen: a plan
// that keeps them keeps the set-point. The position is therefore interpolated from frozen nodes
// alone: a cubic Hermite segment from node i to i+1 whose velocity at a node is that of the chord
// arriving there. That is continuous in position and velocity, and needs no node after i+1. The
// orientation follows the shortest arc between the two nodes. All functions need at least two
// nodes; they throw std::invalid_argument for a cursor outside 0 .. n-1.
#pragma once

#include <cstddef>

#include "prf_decision/types.hpp"

namespace prf_decision {

enum class Direction { kBack = -1, kStand = 0, kForward = 1 };

// Cursor after `dt` along the nominal times, kept within the trajectory.
[[nodiscard]] double advance_cursor(const Trajectory& trajectory, double cursor,
                                    Direction direction, Duration dt);

// Leading nodes that must not move: floor(cursor) + 2, at most all of them.
[[nodiscard]] std::size_t frozen_nodes(const Trajectory& trajectory, double cursor);

// Nominal time from the cursor to the last node.
[[nodiscard]] Duration time_to_go(const Trajectory& trajectory, double cursor);

[[nodiscard]] bool at_end(const Trajectory& trajectory, double cursor);

// Hand at the cursor. Its velocities are those of an execution in `direction`; zero for kStand.
[[nodiscard]] MovingPose hand_at(const Trajectory& trajectory, double cursor, Direction direction);

}  // namespace prf_decision
