// SPDX-License-Identifier: BSD-3-Clause
//
// Whether an arm can have made a demonstration and can follow it. Demonstration itself takes any
// path, also one drawn by hand; a node asks here before it moves an arm along one.
#pragma once

#include "elte_planner/demonstration.hpp"

namespace elte_planner {

struct DemonstrationLimits {
  double reach = 0.0;         // m, of the hand from the origin of the planning frame, [0.1, 10]
  double speed = 1.5;         // m/s from row to row; above it a row is wild
  double turning_rate = 8.0;  // rad/s, the same for the orientation
  double gap = 0.2;           // m from row to row; above it rows are missing
  double duration = 600.0;    // s
  double target = 10.0;       // m, of the target from the origin of the planning frame

  void validate() const;  // throws std::invalid_argument with name, value and bound
};

// Throws std::invalid_argument for a demonstration beyond the limits, with the row (1 is the first
// pose), what it has and what is allowed. Says so when a thousandth of a length or of a time would
// be within its limit, which tells millimetres and milliseconds.
void require_executable(const Demonstration& demonstration, const DemonstrationLimits& limits);

}  // namespace elte_planner
