// SPDX-License-Identifier: BSD-3-Clause
// Turns guards and belief into the event of a tick. Besides what each of them says at that tick:
//
//   a hazard of any guard that lasts for coast_limits[1]      overdue: the arm goes back
//   unsteady for coast_limits[2] with the hand at the target  overdue
//   lost with the hand away from the start of the skill       overdue: the way out comes first
//   lost on the way to the start before an execution, or      overdue: the target may be in view
//   less than coast_limits[2] after it                        again from there
//   out of sight for coast_limits[1] where it can be looked for     missing
//   in sight again while searching, whatever else is wrong    clear
//   search[0] of searching                                    lost
//   overdue while the execution waits at the start            hazard: there is no way to go back
//   overdue or unstable once the execution has ended          only with the hand at the target
// What lasts may pause for the dwell time.
#pragma once

#include <optional>
#include <string>

#include "prf_decision/belief_tracker.hpp"
#include "prf_decision/guards.hpp"
#include "prf_decision/lasting.hpp"

namespace prf_decision {

struct AssessmentInput {
  GuardInput guards;
  State state = State::kIdle;
  bool adapted_once = false;
  bool at_start = false;    // the cursor is at the start of the skill
  bool at_target = false;   // the cursor is on the approach or at the end
  bool away = false;        // the hand is not where the cursor is
  bool can_search = false;  // arm and hand are ready to look for the target from the start
  Duration search_time{0};  // search[0]
  double search_width = 0;  // rad, of the present look
};

struct Assessment {
  Event event = Event::kHazard;
  std::string reason;
  bool violation = false;  // of a guard
  // The HMM believes in Reverse, said beside a hazard; empty: it does not.
  std::string unstable;
};

class Assessor {
 public:
  [[nodiscard]] Assessment assess(const GuardParams& params, Duration dwell_time,
                                  const BeliefTracker& belief, const AssessmentInput& input);

 private:
  [[nodiscard]] std::optional<Assessment> assess_sight(const GuardParams& params,
                                                       const AssessmentInput& input,
                                                       const std::optional<Violation>& violation);

  Lasting hazard_;
  Lasting unsteady_;
  std::optional<Stamp> searching_;  // since
  std::optional<Stamp> rewound_;    // the last tick of going to the start before an execution
};

}  // namespace prf_decision
