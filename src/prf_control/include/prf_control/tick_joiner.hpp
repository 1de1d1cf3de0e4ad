// SPDX-License-Identifier: BSD-3-Clause
// Joins each control tick (measured joints) with the set-point of the same stamp: the StreamJoiner
// of prf_core with the ticks as primary stream, and counts of what was lost.
//
// A tick that comes twice, late or far ahead is dropped. A new run begins when several ticks in a
// row agree that the clock went back (prf_core/clock_monitor.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <prf_core/stream_joiner.hpp>
#include <string>

#include "prf_control/measured_joints.hpp"
#include "prf_control/setpoint.hpp"

namespace prf_control {

struct JoinerCounts {
  std::uint64_t duplicate_ticks = 0;
  std::uint64_t old_ticks = 0;
  std::uint64_t far_ahead_ticks = 0;
  std::uint64_t new_runs = 0;
  std::uint64_t late_setpoints = 0;  // came after their tick was decided, or twice
  std::uint64_t far_ahead_setpoints = 0;
  std::uint64_t missing_setpoints = 0;  // ticks without
  std::uint64_t silences = 0;           // times that the set-points were given up
};

class TickJoiner {
 public:
  using Joined = prf_core::StreamJoiner<JointSample, Setpoint>::Joined;

  explicit TickJoiner(prf_core::Duration max_wait);  // > 0, of data time

  void add_joints(const JointSample& joints);
  void add_setpoint(prf_core::Stamp stamp, const Setpoint& setpoint);
  // The oldest tick when its set-point has come or will not come any more.
  [[nodiscard]] std::optional<Joined> next();

  [[nodiscard]] const JoinerCounts& counts() const { return counts_; }

 private:
  prf_core::StreamJoiner<JointSample, Setpoint> joiner_;
  JoinerCounts counts_;
};

}  // namespace prf_control
