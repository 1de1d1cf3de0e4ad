// SPDX-License-Identifier: BSD-3-Clause
//
// The obstacles of a topic, by stamp: which of them a plan keeps clear of depends on stamps alone,
// not on the order in which messages of different topics arrive.
#pragma once

#include <cstddef>
#include <map>
#include <prf_core/time.hpp>
#include <vector>

#include "elte_planner/placed_obstacle.hpp"

namespace elte_planner {

class ObstacleHistory {
 public:
  // All obstacles that there are from `stamp` on. What is said again for a stamp replaces.
  void add(prf_core::Stamp stamp, std::vector<PlacedObstacle> obstacles);

  // Those of the newest set that is not stamped later; none before the first. Sets older than that
  // are forgotten.
  const std::vector<PlacedObstacle>& at(prf_core::Stamp stamp);

  // Stamps went back to this one: forgets the sets that are stamped later.
  void begin_run(prf_core::Stamp stamp);

  std::size_t count() const { return sets_.empty() ? 0 : sets_.rbegin()->second.size(); }

 private:
  std::map<prf_core::Stamp, std::vector<PlacedObstacle>> sets_;
};

}  // namespace elte_planner
