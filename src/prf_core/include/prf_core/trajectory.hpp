// SPDX-License-Identifier: BSD-3-Clause
// A planned or demonstrated path of the hand: timed poses in the planning frame.
#pragma once

#include <vector>

#include "prf_core/se3.hpp"
#include "prf_core/time.hpp"

namespace prf_core {

struct Trajectory {
  std::vector<Pose> poses;
  // Nominal time of each pose from the start of the skill, strictly rising from 0. An execution
  // that pauses or goes back reaches the pose later.
  std::vector<Duration> times;
  // Demonstrated last pose of the hand in the target's frame. In a plan the last of `poses` belongs
  // to the target predicted for its time; this one holds wherever the target is.
  Pose goal_in_target;

  // Demands at least two poses, as many times, finite positions and unit quaternions. Throws
  // std::invalid_argument naming the member, its value and the bound.
  void validate() const;
};

}  // namespace prf_core
