// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "elte_planner/skill_planner.hpp"

namespace elte_planner {

// How planners that know no constraints plan in the target's frame: by how much the frame in which
// node k was demonstrated is displaced at its time (nodes x dimensions, m). On the approach, and at
// the last node, that is from the demonstrated node to the centre of its ball; between two balls it
// is interpolated, and before the first it grows from 0 at node 0 in proportion to k: a function of
// the balls alone, so that a plan made again for the same ones goes on as before. Once the approach
// has begun, the two frozen nodes next to it continue the first two balls in a straight line; rows
// further back are 0. All rows are 0 without an approach.
[[nodiscard]] Eigen::MatrixXd frame_displacement(const PlanRequest& request,
                                                 const Eigen::MatrixXd& demonstration);

}  // namespace elte_planner
