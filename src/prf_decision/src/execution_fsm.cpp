// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/execution_fsm.hpp"

#include "sentence.hpp"

namespace prf_decision {
namespace {

// States whose reason is the newest violation or belief, not what led into them.
bool waits(ExecutionState state) {
  return state == ExecutionState::kWaiting || state == ExecutionState::kPause ||
         state == ExecutionState::kReverse || state == ExecutionState::kRetract ||
         state == ExecutionState::kSearch;
}

}  // namespace

void ExecutionFsm::begin(Stamp stamp, bool away) {
  cause_ = away ? Event::kBeginAway : Event::kBegin;
  state_ = step(state_, cause_, true);
  since_ = since_but_hazard_ = stamp;
  reason_.clear();
}

bool ExecutionFsm::fire(Stamp stamp, Event event, const std::string& reason, Duration dwell_time) {
  const Stamp since = event == Event::kUnstable ? since_but_hazard_ : since_;
  const State next = step(state_, event, stamp - since >= dwell_time);
  if (next == state_) return false;
  const bool shows = published(next) != published(state_);
  state_ = next;
  if (shows) {
    cause_ = event;
    since_ = stamp;
    if (event != Event::kHazard) since_but_hazard_ = stamp;
    reason_ = reason;
  }
  return true;
}

void ExecutionFsm::explain(const std::string& reason) {
  if (waits(published_state()) && !reason.empty()) reason_ = reason;
}

std::string ExecutionFsm::describe() const {
  return sentence(name(state_), " (", name(published_state()), ") since ", to_seconds(since_),
                  " s by ", name(cause_), reason_.empty() ? "" : ": ", reason_);
}

}  // namespace prf_decision
