// SPDX-License-Identifier: BSD-3-Clause
// The switch to another demonstration, a state machine beside that of the execution:
//
//   requested    a goal names the demonstration; every progress names it until the planner answers
//   returning    the planner has accepted it; the hand goes back along the previous skill
//   settled      the accepted demonstration is executed
//
// A request ends without a switch when the planner refuses it, when the planner does not answer
// within kPatience, or when the goal is preempted. Then the demonstration accepted before stays.
// Every request has a number that comes back with the planner's results, so that these are told
// apart.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "prf_decision/types.hpp"

namespace prf_decision {

enum class SwitchState {
  kSettled,            // the accepted demonstration is executed
  kRequested,          // a goal names another one, the planner has not answered yet
  kReturning,          // accepted; the hand goes back along the previous skill
  kReturningRequested  // the same, and a further goal names yet another one
};
inline constexpr std::size_t kSwitchStates = 4;

enum class SwitchEvent {
  kRequest,
  kAccepted,  // by the planner
  kEnded,     // refused by the planner, not answered in time, or preempted
  kArrived    // at the start, with a plan of the accepted demonstration
};
inline constexpr std::size_t kSwitchEvents = 4;

struct SwitchRow {
  SwitchState from;
  SwitchEvent event;
  SwitchState to;
};

// clang-format off
inline constexpr std::array kSwitchTable{
    SwitchRow{SwitchState::kSettled,            SwitchEvent::kRequest,  SwitchState::kRequested},
    SwitchRow{SwitchState::kRequested,          SwitchEvent::kAccepted, SwitchState::kReturning},
    SwitchRow{SwitchState::kRequested,          SwitchEvent::kEnded,    SwitchState::kSettled},
    SwitchRow{SwitchState::kReturning,          SwitchEvent::kRequest,  SwitchState::kReturningRequested},
    SwitchRow{SwitchState::kReturning,          SwitchEvent::kArrived,  SwitchState::kSettled},
    SwitchRow{SwitchState::kReturningRequested, SwitchEvent::kAccepted, SwitchState::kReturning},
    SwitchRow{SwitchState::kReturningRequested, SwitchEvent::kEnded,    SwitchState::kReturning},
    SwitchRow{SwitchState::kReturningRequested, SwitchEvent::kArrived,  SwitchState::kRequested},
};
// clang-format on

[[nodiscard]] constexpr SwitchState step(SwitchState state, SwitchEvent event) {
  for (const SwitchRow& row : kSwitchTable) {
    if (row.from == state && row.event == event) return row.to;
  }
  return state;
}

[[nodiscard]] const char* name(SwitchState state);
[[nodiscard]] const char* name(SwitchEvent event);

// The table for people, as Markdown.
[[nodiscard]] std::string switch_markdown();

struct NamedDemonstration {
  std::string name;  // empty: the one that the planner started with
  std::uint32_t number = 0;
};

// Which demonstration a planner's result is for.
enum class PlanFor {
  kAnotherRequest,  // one that is no longer asked for: to be ignored
  kRefused,         // the requested one, which is refused
  kAccepted,        // the requested one, for the first time: it is accepted now
  kCurrent          // the one accepted before
};

class DemonstrationSwitch {
 public:
  // Data time for the planner to answer, which it does at its next forecast: 150 of them at 30 Hz.
  static constexpr Duration kPatience = std::chrono::seconds(5);

  void request(const std::string& name);
  void end_request() { state_ = step(state_, SwitchEvent::kEnded); }
  void arrive() { state_ = step(state_, SwitchEvent::kArrived); }

  // Takes a planner's result: the number of its request, and whether the planner refused that.
  // Accepts or ends the request where the number is its own.
  [[nodiscard]] PlanFor receive(std::uint32_t number, bool refused);

  // Whether the planner's answer is overdue at this tick. The time counts from the first call after
  // the request. False when nothing is requested.
  [[nodiscard]] bool is_overdue(Stamp tick);

  [[nodiscard]] SwitchState state() const { return state_; }
  [[nodiscard]] bool is_requested() const {
    return state_ == SwitchState::kRequested || state_ == SwitchState::kReturningRequested;
  }
  [[nodiscard]] bool is_returning() const {
    return state_ == SwitchState::kReturning || state_ == SwitchState::kReturningRequested;
  }
  // The demonstration that the planner shall follow.
  [[nodiscard]] const NamedDemonstration& wanted() const {
    return is_requested() ? requested_ : accepted_;
  }

 private:
  SwitchState state_ = SwitchState::kSettled;
  NamedDemonstration requested_;
  NamedDemonstration accepted_;
  std::optional<Stamp> requested_at_;
};

}  // namespace prf_decision
