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
  kDynamicTimeWarping,  // nodes of the others to the first one's by least summed squared distance
};

// `nodes` mean samples. Every demonstration is first moved rigidly so that its target lies where
// the first one's does. Times are means, too; orientations are those nearest to all (chordal mean).
// Throws std::invalid_argument for no demonstrations or different frames.
[[nodiscard]] Demonstration combined(const std::vector<Demonstration>& demonstrations,
                                     std::size_t nodes, Alignment alignment);

}  // namespace elte_planner
