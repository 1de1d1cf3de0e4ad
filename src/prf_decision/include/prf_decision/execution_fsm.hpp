// SPDX-License-Identifier: BSD-3-Clause
// Runs the table of decision_fsm.hpp. Holds the state, since when it is published, and why.
#pragma once

#include <string>

#include "prf_decision/decision_fsm.hpp"
#include "prf_decision/types.hpp"

namespace prf_decision {

class ExecutionFsm {
 public:
  // Whether an execution can begin: none is under way.
  [[nodiscard]] bool can_begin() const { return is_resting(state_); }
  // Needs can_begin(). `away`: by kBeginAway, the hand has to go back to the start first.
  void begin(Stamp stamp, bool away);

  // Takes the transition of the event and returns whether the table has one. When the published
  // state changes, `stamp`, `event` and `reason` become its beginning and its cause; else the
  // former ones stay.
  bool fire(Stamp stamp, Event event, const std::string& reason, Duration dwell_time);

  // Replaces the reason in states that wait for something (waiting, pause, reverse, retract,
  // search), unless `reason` is empty.
  void explain(const std::string& reason);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] ExecutionState published_state() const { return published(state_); }
  [[nodiscard]] Event cause() const { return cause_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }
  // As "rewinding (reverse) since 12.34 s by clear: back to the start of the skill".
  [[nodiscard]] std::string describe() const;

 private:
  State state_ = State::kIdle;
  Event cause_ = Event::kHazard;  // that led into the published state
  std::string reason_;            // why the state holds; may be empty
  Stamp since_{0};                // that the published state holds
  // The same, but a change by a hazard does not count: a target that is unstable and beyond a
  // guard's bound too is left as soon as one that is unstable only.
  Stamp since_but_hazard_{0};
};

}  // namespace prf_decision
