// SPDX-License-Identifier: BSD-3-Clause
// Keeps the set-point from jumping when its reference does (skill to target and back, a plan or a
// forecast that changed late), and from shaking with the noise of successive forecasts.
//
// The set-point s moves with the velocity v of the reference r. It closes the gap e that remains
// with time constant T (first order), and at most at the speed c:
//   e = r - (s + v dt),   s' = s + v dt + e min(1 - exp(-dt / T), c dt / |e|).
// The same holds for the orientation with rotation vectors. Behind a reference with acceleration a
// the set-point lags by about a T dt / 2: 0.3 mm at 0.6 m/s^2, T = 0.1 s, 100 Hz.
#pragma once

#include "prf_decision/types.hpp"

namespace prf_decision {

struct CatchUpParams {
  double linear = 0;         // m/s
  double angular = 0;        // rad/s
  double time_constant = 0;  // s

  void validate() const;
};

[[nodiscard]] MovingPose limited_setpoint(const Pose& previous, const MovingPose& reference,
                                          const CatchUpParams& catch_up, Duration dt);

}  // namespace prf_decision
