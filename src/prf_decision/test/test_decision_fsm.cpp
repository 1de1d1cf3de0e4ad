// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/decision_fsm.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace prf_decision {
namespace {

constexpr std::array kAllStates{State::kWaiting,  State::kForward, State::kPause, State::kReverse,
                                State::kTracking, State::kRetract, State::kDone,  State::kStopped};
constexpr std::array kAllEvents{Event::kCalm,   Event::kUnsteady, Event::kUnstable,
                                Event::kHazard, Event::kOverdue,  Event::kLost,
                                Event::kTimeUp, Event::kComplete, Event::kHeld,
                                Event::kRewind, Event::kPreempted};

bool listed(State state, Event event) {
  return std::any_of(kTable.begin(), kTable.end(),
                     [&](const Row& row) { return row.from == state && row.event == event; });
}

// What is demanded of the decision, written down a second time and independently.
const std::map<std::pair<State, Event>, State> kDemanded{
    {{State::kWaiting, Event::kCalm}, State::kForward},
    {{State::kWaiting, Event::kRewind}, State::kReverse},
    {{State::kForward, Event::kUnsteady}, State::kPause},
    {{State::kForward, Event::kUnstable}, State::kReverse},
    {{State::kForward, Event::kHazard}, State::kPause},
    {{State::kForward, Event::kOverdue}, State::kReverse},
    {{State::kForward, Event::kComplete}, State::kTracking},
    {{State::kPause, Event::kCalm}, State::kForward},
    {{State::kPause, Event::kRewind}, State::kReverse},
    {{State::kPause, Event::kUnstable}, State::kReverse},
    {{State::kPause, Event::kOverdue}, State::kReverse},
    {{State::kReverse, Event::kCalm}, State::kForward},
    {{State::kReverse, Event::kUnsteady}, State::kPause},
    {{State::kReverse, Event::kHazard}, State::kPause},
    {{State::kTracking, Event::kUnstable}, State::kRetract},
    {{State::kTracking, Event::kHazard}, State::kPause},
    {{State::kTracking, Event::kOverdue}, State::kRetract},
    {{State::kTracking, Event::kHeld}, State::kDone},
    {{State::kRetract, Event::kCalm}, State::kForward},
    {{State::kRetract, Event::kUnsteady}, State::kPause},
    {{State::kRetract, Event::kHazard}, State::kPause},
};

State demanded(State state, Event event) {
  const bool final = state == State::kDone || state == State::kStopped;
  if (!final && event == Event::kTimeUp) return State::kStopped;
  if (!final && event == Event::kPreempted) return State::kStopped;
  if (!final && state != State::kWaiting && event == Event::kLost) return State::kStopped;
  const auto found = kDemanded.find({state, event});
  return found == kDemanded.end() ? state : found->second;
}

TEST(DecisionFsm, GoesWhereEveryRowSaysAndStaysOnEveryUnlistedPair) {
  for (const State state : kAllStates) {
    for (const Event event : kAllEvents) {
      EXPECT_EQ(step(state, event, true), demanded(state, event))
          << name(state) << " + " << name(event);
      EXPECT_EQ(listed(state, event), demanded(state, event) != state)
          << name(state) << " + " << name(event);
    }
  }
}

TEST(DecisionFsm, LetsOnlyTheHmmWaitForTheDwellTime) {
  const std::set<Event> from_hmm{Event::kCalm, Event::kUnsteady, Event::kUnstable};
  for (const Row& row : kTable) {
    const bool waits = from_hmm.count(row.event) == 1 && row.from != State::kWaiting;
    EXPECT_EQ(row.guard == Guard::kDwelled, waits) << name(row.from) << " + " << name(row.event);
    EXPECT_EQ(step(row.from, row.event, false), waits ? row.from : row.to);
  }
}

TEST(DecisionFsm, ListsNoPairTwice) {
  std::set<std::pair<State, Event>> seen;
  for (const Row& row : kTable) {
    EXPECT_TRUE(seen.insert({row.from, row.event}).second)
        << name(row.from) << " + " << name(row.event);
  }
}

TEST(DecisionFsm, NeverLeavesItsFinalStates) {
  for (const Event event : kAllEvents) {
    EXPECT_EQ(step(State::kDone, event, true), State::kDone);
    EXPECT_EQ(step(State::kStopped, event, true), State::kStopped);
  }
}

TEST(DecisionFsm, PrintsOneLinePerRowInBothForms) {
  const std::string markdown = fsm_markdown();
  const std::string dot = fsm_dot();
  EXPECT_EQ(std::count(markdown.begin(), markdown.end(), '\n'),
            static_cast<std::ptrdiff_t>(kTable.size()) + 2);
  EXPECT_NE(markdown.find("| forward | unsteady [dwelled] | pause |"), std::string::npos);
  EXPECT_NE(dot.find("tracking -> done [label=\"held\"];"), std::string::npos);
}

}  // namespace
}  // namespace prf_decision
