// SPDX-License-Identifier: BSD-3-Clause
// The state machine of the skill's execution, as one table of rows
//
//   state + event [dwelled] = next
//
// An event that is not listed for a state leaves the state as it is. A row marked kDwelled acts
// only when the published state has lasted the dwell time: its event comes from the HMM, whose
// belief may chatter. The events of the other rows come from guards, milestones and goals. These
// rows act at once and whatever the HMM believes.
//
// The reaction is monotone: of the events calm, unsteady, hazard, unstable, overdue, in this order,
// a later one never leads to a bolder state than an earlier one (boldness()); nor does missing,
// where it may come. What goes back is not
// stopped by a hazard; so the way out needs neither forecast nor planner nor a goal in reach.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace prf_decision {

// As in prf_msgs/ExecutionProgress.
enum class ExecutionState {
  kWaiting,
  kForward,
  kPause,
  kReverse,
  kTracking,
  kRetract,
  kDone,
  kStopped,
  kSearch
};
inline constexpr std::size_t kExecutionStates = 9;

enum class State {
  kIdle,           // no goal yet, or the target was left after an execution
  kWaiting,        // for the guards, to begin
  kRewindWaiting,  // the same, then back to the start of the skill
  kForward,
  kPause,
  kReverse,    // back along the skill, as far as its start, until the HMM believes otherwise
  kRewinding,  // back to the start of the skill, before the execution begins
  kTracking,   // of the target, at the end of the skill
  kRetract,    // back from the target
  kLeaving,    // the same once the execution has ended; as far as the start
  kDone,
  kStopped,
  kSearch  // at the start of the skill, for a target that is out of sight
};
inline constexpr std::size_t kStates = 13;

enum class Event {
  kCalm,       // no violation, the HMM believes in Forward
  kUnsteady,   // no violation, the HMM believes in Pause
  kUnstable,   // the HMM believes in Reverse
  kClear,      // no violation, whatever the HMM believes; instead of these three while rewinding.
               // While searching: the target is in sight again
  kHazard,     // a guard reports a violation
  kOverdue,    // a violation that has lasted so long that the arm shall go back
  kMissing,    // the target is out of sight and can be looked for; at the start of the skill only
  kLost,       // the last measurement is so old, or the search so long, that the skill is given up;
               // at its start only
  kGiveUp,     // the arm has not followed for so long that the skill is given up
  kAway,       // no violation, but the hand is not where the skill is to go on
  kTimeUp,     // time limit passed
  kComplete,   // the cursor stands on the last node
  kHeld,       // the target was tracked for the hold time
  kAtStart,    // cursor and hand are at the start of the skill to execute
  kPreempted,  // the goal was cancelled
  kBegin,      // a goal begins where the cursor is
  kBeginAway   // a goal begins at the start; the cursor is elsewhere or on another demonstration
};
inline constexpr std::size_t kEvents = 17;

enum class Condition { kNone, kDwelled };

struct Row {
  State from;
  Event event;
  Condition condition;
  State to;
};

// clang-format off
inline constexpr std::array kTable{
    //  state                  event              condition            next
    Row{State::kIdle,          Event::kBegin,     Condition::kNone,    State::kWaiting},
    Row{State::kIdle,          Event::kBeginAway, Condition::kNone,    State::kRewindWaiting},

    Row{State::kWaiting,       Event::kCalm,      Condition::kNone,    State::kForward},
    Row{State::kWaiting,       Event::kAway,      Condition::kNone,    State::kRewinding},
    Row{State::kWaiting,       Event::kOverdue,   Condition::kNone,    State::kReverse},
    Row{State::kWaiting,       Event::kMissing,   Condition::kNone,    State::kSearch},
    Row{State::kWaiting,       Event::kTimeUp,    Condition::kNone,    State::kStopped},
    Row{State::kWaiting,       Event::kPreempted, Condition::kNone,    State::kStopped},

    Row{State::kRewindWaiting, Event::kClear,     Condition::kNone,    State::kRewinding},
    Row{State::kRewindWaiting, Event::kOverdue,   Condition::kNone,    State::kRewinding},
    Row{State::kRewindWaiting, Event::kMissing,   Condition::kNone,    State::kSearch},
    Row{State::kRewindWaiting, Event::kTimeUp,    Condition::kNone,    State::kStopped},
    Row{State::kRewindWaiting, Event::kPreempted, Condition::kNone,    State::kStopped},

    Row{State::kForward,       Event::kUnsteady,  Condition::kDwelled, State::kPause},
    Row{State::kForward,       Event::kUnstable,  Condition::kDwelled, State::kReverse},
    Row{State::kForward,       Event::kHazard,    Condition::kNone,    State::kPause},
    Row{State::kForward,       Event::kOverdue,   Condition::kNone,    State::kReverse},
    Row{State::kForward,       Event::kComplete,  Condition::kNone,    State::kTracking},
    Row{State::kForward,       Event::kMissing,   Condition::kNone,    State::kSearch},
    Row{State::kForward,       Event::kLost,      Condition::kNone,    State::kStopped},
    Row{State::kForward,       Event::kGiveUp,    Condition::kNone,    State::kStopped},
    Row{State::kForward,       Event::kTimeUp,    Condition::kNone,    State::kStopped},
    Row{State::kForward,       Event::kPreempted, Condition::kNone,    State::kStopped},

    Row{State::kPause,         Event::kCalm,      Condition::kDwelled, State::kForward},
    Row{State::kPause,         Event::kUnstable,  Condition::kDwelled, State::kReverse},
    Row{State::kPause,         Event::kOverdue,   Condition::kNone,    State::kReverse},
    Row{State::kPause,         Event::kMissing,   Condition::kNone,    State::kSearch},
    Row{State::kPause,         Event::kLost,      Condition::kNone,    State::kStopped},
    Row{State::kPause,         Event::kGiveUp,    Condition::kNone,    State::kStopped},
    Row{State::kPause,         Event::kTimeUp,    Condition::kNone,    State::kStopped},
    Row{State::kPause,         Event::kPreempted, Condition::kNone,    State::kStopped},

    Row{State::kReverse,       Event::kCalm,      Condition::kDwelled, State::kForward},
    Row{State::kReverse,       Event::kUnsteady,  Condition::kDwelled, State::kPause},
    Row{State::kReverse,       Event::kMissing,   Condition::kNone,    State::kSearch},
    Row{State::kReverse,       Event::kLost,      Condition::kNone,    State::kStopped},
    Row{State::kReverse,       Event::kGiveUp,    Condition::kNone,    State::kStopped},
    Row{State::kReverse,       Event::kTimeUp,    Condition::kNone,    State::kStopped},
    Row{State::kReverse,       Event::kPreempted, Condition::kNone,    State::kStopped},

    Row{State::kRewinding,     Event::kAtStart,   Condition::kNone,    State::kReverse},
    Row{State::kRewinding,     Event::kMissing,   Condition::kNone,    State::kSearch},
    Row{State::kRewinding,     Event::kLost,      Condition::kNone,    State::kStopped},
    Row{State::kRewinding,     Event::kGiveUp,    Condition::kNone,    State::kStopped},
    Row{State::kRewinding,     Event::kTimeUp,    Condition::kNone,    State::kStopped},
    Row{State::kRewinding,     Event::kPreempted, Condition::kNone,    State::kStopped},

    Row{State::kTracking,      Event::kUnstable,  Condition::kDwelled, State::kRetract},
    Row{State::kTracking,      Event::kHazard,    Condition::kNone,    State::kPause},
    Row{State::kTracking,      Event::kOverdue,   Condition::kNone,    State::kRetract},
    Row{State::kTracking,      Event::kHeld,      Condition::kNone,    State::kDone},
    Row{State::kTracking,      Event::kLost,      Condition::kNone,    State::kStopped},
    Row{State::kTracking,      Event::kGiveUp,    Condition::kNone,    State::kStopped},
    Row{State::kTracking,      Event::kTimeUp,    Condition::kNone,    State::kStopped},
    Row{State::kTracking,      Event::kPreempted, Condition::kNone,    State::kStopped},

    Row{State::kRetract,       Event::kCalm,      Condition::kDwelled, State::kForward},
    Row{State::kRetract,       Event::kUnsteady,  Condition::kDwelled, State::kPause},
    Row{State::kRetract,       Event::kMissing,   Condition::kNone,    State::kSearch},
    Row{State::kRetract,       Event::kLost,      Condition::kNone,    State::kStopped},
    Row{State::kRetract,       Event::kGiveUp,    Condition::kNone,    State::kStopped},
    Row{State::kRetract,       Event::kTimeUp,    Condition::kNone,    State::kStopped},
    Row{State::kRetract,       Event::kPreempted, Condition::kNone,    State::kStopped},

    Row{State::kLeaving,       Event::kAtStart,   Condition::kNone,    State::kIdle},
    Row{State::kLeaving,       Event::kGiveUp,    Condition::kNone,    State::kStopped},
    Row{State::kLeaving,       Event::kBegin,     Condition::kNone,    State::kWaiting},
    Row{State::kLeaving,       Event::kBeginAway, Condition::kNone,    State::kRewindWaiting},

    Row{State::kDone,          Event::kUnstable,  Condition::kDwelled, State::kLeaving},
    Row{State::kDone,          Event::kOverdue,   Condition::kNone,    State::kLeaving},
    Row{State::kDone,          Event::kBegin,     Condition::kNone,    State::kWaiting},
    Row{State::kDone,          Event::kBeginAway, Condition::kNone,    State::kRewindWaiting},

    Row{State::kStopped,       Event::kUnstable,  Condition::kDwelled, State::kLeaving},
    Row{State::kStopped,       Event::kOverdue,   Condition::kNone,    State::kLeaving},
    Row{State::kStopped,       Event::kBegin,     Condition::kNone,    State::kWaiting},
    Row{State::kStopped,       Event::kBeginAway, Condition::kNone,    State::kRewindWaiting},

    Row{State::kSearch,        Event::kClear,     Condition::kNone,    State::kRewinding},
    Row{State::kSearch,        Event::kLost,      Condition::kNone,    State::kStopped},
    Row{State::kSearch,        Event::kGiveUp,    Condition::kNone,    State::kStopped},
    Row{State::kSearch,        Event::kTimeUp,    Condition::kNone,    State::kStopped},
    Row{State::kSearch,        Event::kPreempted, Condition::kNone,    State::kStopped},
};

// Every state with the one that is published for it.
inline constexpr std::array<ExecutionState, kStates> kPublished{
    ExecutionState::kWaiting,  // idle
    ExecutionState::kWaiting,  // waiting
    ExecutionState::kWaiting,  // rewind waiting
    ExecutionState::kForward,  ExecutionState::kPause,
    ExecutionState::kReverse,
    ExecutionState::kReverse,  // rewinding
    ExecutionState::kTracking, ExecutionState::kRetract,
    ExecutionState::kRetract,  // leaving
    ExecutionState::kDone,     ExecutionState::kStopped,
    ExecutionState::kSearch};
// clang-format on

[[nodiscard]] constexpr ExecutionState published(State state) {
  return kPublished[static_cast<std::size_t>(state)];
}

[[nodiscard]] constexpr State step(State state, Event event, bool dwelled) {
  for (const Row& row : kTable) {
    if (row.from != state || row.event != event) continue;
    return row.condition == Condition::kNone || dwelled ? row.to : state;
  }
  return state;
}

[[nodiscard]] constexpr bool is_rewinding(State state) {
  return state == State::kRewindWaiting || state == State::kRewinding;
}

// No execution is under way: a goal can begin.
[[nodiscard]] constexpr bool is_resting(State state) {
  return step(state, Event::kBegin, true) != state;
}

// How near the target a state keeps the hand while a danger lasts: 2 goes or stays there, 1 stands,
// 0 goes away from it, stays at the start of the skill, or has ended.
[[nodiscard]] constexpr int boldness(State state) {
  switch (state) {
    case State::kForward:
    case State::kTracking:
    case State::kDone:
      return 2;
    case State::kWaiting:
    case State::kRewindWaiting:
    case State::kPause:
    case State::kStopped:
      return 1;
    case State::kIdle:
    case State::kReverse:
    case State::kRewinding:
    case State::kRetract:
    case State::kLeaving:
    case State::kSearch:
      break;
  }
  return 0;
}

[[nodiscard]] const char* name(ExecutionState state);
[[nodiscard]] const char* name(State state);
[[nodiscard]] const char* name(Event event);

// The table for people: Markdown with a line for each state, and a Graphviz graph.
[[nodiscard]] std::string fsm_markdown();
[[nodiscard]] std::string fsm_dot();

}  // namespace prf_decision
