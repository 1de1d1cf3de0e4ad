// SPDX-License-Identifier: BSD-3-Clause
//
// Several demonstrations of one skill as one. For demonstrations zeta_1 .. zeta_m that are aligned
// node by node, with mean zeta,
//
//   sum_i |L(y - zeta_i)|^2 = m |L(y - zeta)|^2 + (what does not depend on y),
//
// because the cross term is 2 L(y - zeta) . sum_i L(zeta - zeta_i) = 0. Editing the mean therefore
// is editing all of them, exactly, not an approximation.
#pragma once

#include <cstddef>
#include <vector>

#include "elte_planner/demonstration.hpp"

namespace elte_planner {

enum class Alignment {
  kArcLength,           // nodes at equal shares of each path's length
  kDynamicTimeWarping,  // each node of the first one is matched by least summed squared distance
};

// The result has `nodes` samples, at least 3. Every demonstration is resampled to as many by arc
// length and moved rigidly so that its target lies where the first one's does. Positions and times
// are means, orientations are normalised mean quaternions. Throws std::invalid_argument when there
// are no demonstrations, when frames differ, or when orientations at one node cancel each other.
[[nodiscard]] Demonstration combined(const std::vector<Demonstration>& demonstrations,
                                     std::size_t nodes, Alignment alignment);

}  // namespace elte_planner
