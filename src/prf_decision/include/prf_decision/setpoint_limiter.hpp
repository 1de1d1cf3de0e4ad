// SPDX-License-Identifier: BSD-3-Clause
// Keeps the set-point from jumping when its reference does (skill to target and back, a plan or a
// forecast that changed late).
//
// The set-point s moves with the reference's velocity v and closes the gap e that remains with a
// bounded speed c:   e = r - (s + v dt),   s' = s + v dt + e min(1, c dt / |e|).
// The same holds for the orientation with rotation vectors. A set-point that has caught up equals
// its reference exactly.
#pragma once

#include "prf_decision/motion.hpp"

namespace prf_decision {

struct CatchUpSpeed {
  double linear = 0;   // m/s
  double angular = 0;  // rad/s

  void validate() const;
};

[[nodiscard]] MovingPose limited_setpoint(const Pose& previous, const MovingPose& reference,
                                          const CatchUpSpeed& speed, Duration dt);

}  // namespace prf_decision
