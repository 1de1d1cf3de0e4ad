// SPDX-License-Identifier: BSD-3-Clause
// A planned or demonstrated path of the hand: timed poses in the planning frame.
#pragma once

#include <vector>

#include "prf_core/se3.hpp"
#include "prf_core/time.hpp"

namespace prf_core {

struct Trajectory {
  std::vector<Pose> poses;
  std::vector<Duration> times;  // nominal time of each pose, strictly rising from 0
  Pose goal_in_target;          // last pose of the hand in the target's frame

  // At least two poses, as many times, all finite and unit. Throws std::invalid_argument naming the
  // member, its value and the bound.
  void validate() const;
};

}  // namespace prf_core
