// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/obstacle_history.hpp"

#include <iterator>
#include <utility>

namespace elte_planner {
namespace {

constexpr std::size_t kMostSets = 1000;  // that wait for their time

}  // namespace

void ObstacleHistory::add(prf_core::Stamp stamp, std::vector<PlacedObstacle> obstacles) {
  sets_[stamp] = std::move(obstacles);
  if (sets_.size() > kMostSets) sets_.erase(sets_.begin());
}

const std::vector<PlacedObstacle>& ObstacleHistory::at(prf_core::Stamp stamp) {
  static const std::vector<PlacedObstacle> kNone;
  const auto later = sets_.upper_bound(stamp);
  if (later == sets_.begin()) return kNone;
  const auto newest = std::prev(later);
  sets_.erase(sets_.begin(), newest);
  return newest->second;
}

void ObstacleHistory::begin_run(prf_core::Stamp stamp) {
  sets_.erase(sets_.upper_bound(stamp), sets_.end());
}

}  // namespace elte_planner
