// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/trajectory.hpp"

#include <string>

#include "prf_core/require.hpp"

namespace prf_core {

void Trajectory::validate() const {
  require(poses.size() >= 2, "number of poses", poses.size(), "at least 2");
  require(times.size() == poses.size(), "number of times", times.size(),
          "that of the poses, " + std::to_string(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string index = "[" + std::to_string(i) + "]";
    require_pose("poses" + index, poses[i]);
    const bool rises = i == 0 ? times[0] == Duration{0} : times[i] > times[i - 1];
    require(rises, "times" + index, to_seconds(times[i]), i == 0 ? "0 s" : "greater than before");
  }
  require_pose("goal_in_target", goal_in_target);
}

}  // namespace prf_core
