// SPDX-License-Identifier: BSD-3-Clause
// Stamps and durations of data, in whole nanoseconds so that equal stamps compare equal.
#pragma once

#include <chrono>
#include <cmath>

namespace prf_core {

using Duration = std::chrono::nanoseconds;
// Since the epoch of the clock that stamped the data: 1970 on a robot, the start in simulation.
using Stamp = std::chrono::nanoseconds;

// Rounded to the nearest nanosecond. `seconds` must be finite and within +-292 years, which is not
// checked.
inline Duration from_seconds(double seconds) { return Duration{std::llround(seconds * 1e9)}; }

inline double to_seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace prf_core
