// SPDX-License-Identifier: BSD-3-Clause
// Runs the table of decision_fsm.hpp: the state, since when it is published, and why.
#pragma once

#include <string>

#include "prf_decision/decision_fsm.hpp"
#include "prf_decision/types.hpp"

namespace prf_decision {

class ExecutionFsm {
 public:
  // Whether an execution can begin: none is under way.
  [[nodiscard]] bool can_begin() const { return step(state_, Event::kBegin, true) != state_; }
  void begin(Stamp stamp, bool away);

  // Whether the event has a row that acts. Since when and why a state holds are kept where the
  // published state stays.
  bool fire(Stamp stamp, Event event, const std::string& reason, Duration dwell_time);

  // The reason why a state that waits for something still holds.
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
  std::string reason_;            // why the state holds; empty while nothing is to be said
  Stamp since_{0};                // that the published state holds
};

}  // namespace prf_decision
