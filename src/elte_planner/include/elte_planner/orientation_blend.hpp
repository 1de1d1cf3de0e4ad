// SPDX-License-Identifier: BSD-3-Clause
//
// Orientations along an edited path. The demonstrated orientation D_k is corrected by a rotation
// C_k of the planning frame, R_k = C_k D_k: at the last frozen node C is what the previous plan has
// there, at the last nodes it takes D to their goals, between them it moves along the geodesic by
// the same angle at each node. So frozen nodes stay, the orientation is continuous after the last
// frozen node, the end is the goal, and planning again one node later for the same goals changes
// nothing.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace elte_planner {

// frozen: 1 .. nodes; goals: of the last nodes, at least of one. Throws std::invalid_argument when
// sizes differ or frozen is out of range.
[[nodiscard]] std::vector<Eigen::Quaterniond> blend_orientations(
    const std::vector<Eigen::Quaterniond>& demonstrated,
    const std::vector<Eigen::Quaterniond>& previous, Eigen::Index frozen,
    const std::vector<Eigen::Quaterniond>& goals);

}  // namespace elte_planner
