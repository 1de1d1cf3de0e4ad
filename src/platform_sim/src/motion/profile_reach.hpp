// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "platform_sim/platform_profile.hpp"

namespace platform_sim {

/// Largest magnitudes of an axis: m or rad, and their first and second derivatives.
struct Reach {
  double value = 0.0, velocity = 0.0, acceleration = 0.0;
};

/// What the sines would reach together: never below the truth. The lag makes each smaller by
/// cos(atan(rate lag)).
[[nodiscard]] Reach reach_of(const AxisProfile& axis);

/// What the steady motion reaches in the first 720 s of its phase, which is more than a trial with
/// any phase takes; sampled, 0.1 % low at most.
[[nodiscard]] Reach sampled_reach_of(const AxisProfile& axis);

}  // namespace platform_sim
