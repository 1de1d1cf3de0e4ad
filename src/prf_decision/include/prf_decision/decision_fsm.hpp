// SPDX-License-Identifier: BSD-3-Clause
// The state machine of the skill's execution, as one table.
//
//   state + event [dwelled] = next
//
// A pair that is not listed stays. Rows marked kDwelled act only when the state has lasted the
// dwell time: they follow the HMM, which may chatter. The others are guards and milestones, which
// act at once and whatever the HMM says.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace prf_decision {

enum class State { kWaiting, kForward, kPause, kReverse, kTracking, kRetract, kDone, kStopped };
inline constexpr std::size_t kStates = 8;

enum class Event {
  kCalm,      // no guard objects, the HMM says Forward
  kUnsteady,  // no guard objects, the HMM says Pause
  kUnstable,  // no guard objects, the HMM says Reverse
  kHazard,    // a guard objects: input stale or refused, target coasting, goal out of reach
  kOverdue,   // target unseen for so long that the arm should go back
  kLost,      // target unseen for so long that the skill is given up
  kTimeUp,    // time limit passed
  kComplete,  // the cursor stands on the last node
  kHeld,      // the target was tracked for the hold time
  kRewind,    // no guard objects, the skill is to begin but the cursor is not at its start
  kPreempted  // asked to stop
};
inline constexpr std::size_t kEvents = 11;

enum class Guard { kNone, kDwelled };

struct Row {
  State from;
  Event event;
  Guard guard;
  State to;
};

// clang-format off
inline constexpr std::array kTable{
    //  state              event              guard            next
    Row{State::kWaiting,   Event::kCalm,      Guard::kNone,    State::kForward},
    Row{State::kWaiting,   Event::kRewind,    Guard::kNone,    State::kReverse},
    Row{State::kWaiting,   Event::kTimeUp,    Guard::kNone,    State::kStopped},
    Row{State::kWaiting,   Event::kPreempted, Guard::kNone,    State::kStopped},

    Row{State::kForward,   Event::kUnsteady,  Guard::kDwelled, State::kPause},
    Row{State::kForward,   Event::kUnstable,  Guard::kDwelled, State::kReverse},
    Row{State::kForward,   Event::kHazard,    Guard::kNone,    State::kPause},
    Row{State::kForward,   Event::kOverdue,   Guard::kNone,    State::kReverse},
    Row{State::kForward,   Event::kComplete,  Guard::kNone,    State::kTracking},
    Row{State::kForward,   Event::kLost,      Guard::kNone,    State::kStopped},
    Row{State::kForward,   Event::kTimeUp,    Guard::kNone,    State::kStopped},
    Row{State::kForward,   Event::kPreempted, Guard::kNone,    State::kStopped},

    Row{State::kPause,     Event::kCalm,      Guard::kDwelled, State::kForward},
    Row{State::kPause,     Event::kRewind,    Guard::kNone,    State::kReverse},
    Row{State::kPause,     Event::kUnstable,  Guard::kDwelled, State::kReverse},
    Row{State::kPause,     Event::kOverdue,   Guard::kNone,    State::kReverse},
    Row{State::kPause,     Event::kLost,      Guard::kNone,    State::kStopped},
    Row{State::kPause,     Event::kTimeUp,    Guard::kNone,    State::kStopped},
    Row{State::kPause,     Event::kPreempted, Guard::kNone,    State::kStopped},

    Row{State::kReverse,   Event::kCalm,      Guard::kDwelled, State::kForward},
    Row{State::kReverse,   Event::kUnsteady,  Guard::kDwelled, State::kPause},
    Row{State::kReverse,   Event::kHazard,    Guard::kNone,    State::kPause},
    Row{State::kReverse,   Event::kLost,      Guard::kNone,    State::kStopped},
    Row{State::kReverse,   Event::kTimeUp,    Guard::kNone,    State::kStopped},
    Row{State::kReverse,   Event::kPreempted, Guard::kNone,    State::kStopped},

    Row{State::kTracking,  Event::kUnstable,  Guard::kDwelled, State::kRetract},
    Row{State::kTracking,  Event::kHazard,    Guard::kNone,    State::kPause},
    Row{State::kTracking,  Event::kOverdue,   Guard::kNone,    State::kRetract},
    Row{State::kTracking,  Event::kHeld,      Guard::kNone,    State::kDone},
    Row{State::kTracking,  Event::kLost,      Guard::kNone,    State::kStopped},
    Row{State::kTracking,  Event::kTimeUp,    Guard::kNone,    State::kStopped},
    Row{State::kTracking,  Event::kPreempted, Guard::kNone,    State::kStopped},

    Row{State::kRetract,   Event::kCalm,      Guard::kDwelled, State::kForward},
    Row{State::kRetract,   Event::kUnsteady,  Guard::kDwelled, State::kPause},
    Row{State::kRetract,   Event::kHazard,    Guard::kNone,    State::kPause},
    Row{State::kRetract,   Event::kLost,      Guard::kNone,    State::kStopped},
    Row{State::kRetract,   Event::kTimeUp,    Guard::kNone,    State::kStopped},
    Row{State::kRetract,   Event::kPreempted, Guard::kNone,    State::kStopped},
};
// clang-format on

[[nodiscard]] constexpr State step(State state, Event event, bool dwelled) {
  for (const Row& row : kTable) {
    if (row.from != state || row.event != event) continue;
    return row.guard == Guard::kNone || dwelled ? row.to : state;
  }
  return state;
}

[[nodiscard]] const char* name(State state);
[[nodiscard]] const char* name(Event event);

// The table for people: a Markdown table, and a Graphviz graph.
[[nodiscard]] std::string fsm_markdown();
[[nodiscard]] std::string fsm_dot();

}  // namespace prf_decision
