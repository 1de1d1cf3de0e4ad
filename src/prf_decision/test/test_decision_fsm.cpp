// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/decision_fsm.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "prf_decision/execution_fsm.hpp"

namespace prf_decision {
namespace {

template <typename Enum, std::size_t kCount>
std::array<Enum, kCount> all() {
  std::array<Enum, kCount> values;
  for (std::size_t i = 0; i < kCount; ++i) values[i] = static_cast<Enum>(i);
  return values;
}
const auto kAllStates = all<State, kStates>();
const auto kAllEvents = all<Event, kEvents>();

bool listed(State state, Event event) {
  return std::any_of(kTable.begin(), kTable.end(),
                     [&](const Row& row) { return row.from == state && row.event == event; });
}

// What is demanded of the decision, written down a second time and independently.
const std::map<std::pair<State, Event>, State> kDemanded{
    {{State::kWaiting, Event::kCalm}, State::kForward},
    {{State::kWaiting, Event::kAway}, State::kRewinding},
    {{State::kWaiting, Event::kOverdue}, State::kReverse},
    {{State::kRewindWaiting, Event::kClear}, State::kRewinding},
    {{State::kRewindWaiting, Event::kOverdue}, State::kRewinding},
    {{State::kForward, Event::kUnsteady}, State::kPause},
    {{State::kForward, Event::kUnstable}, State::kReverse},
    {{State::kForward, Event::kHazard}, State::kPause},
    {{State::kForward, Event::kOverdue}, State::kReverse},
    {{State::kForward, Event::kComplete}, State::kTracking},
    {{State::kPause, Event::kCalm}, State::kForward},
    {{State::kPause, Event::kUnstable}, State::kReverse},
    {{State::kPause, Event::kOverdue}, State::kReverse},
    {{State::kReverse, Event::kCalm}, State::kForward},
    {{State::kReverse, Event::kUnsteady}, State::kPause},
    {{State::kRewinding, Event::kAtStart}, State::kReverse},
    {{State::kTracking, Event::kUnstable}, State::kRetract},
    {{State::kTracking, Event::kHazard}, State::kPause},
    {{State::kTracking, Event::kOverdue}, State::kRetract},
    {{State::kTracking, Event::kHeld}, State::kDone},
    {{State::kRetract, Event::kCalm}, State::kForward},
    {{State::kRetract, Event::kUnsteady}, State::kPause},
    {{State::kLeaving, Event::kAtStart}, State::kIdle},
    {{State::kLeaving, Event::kGiveUp}, State::kStopped},
    {{State::kDone, Event::kUnstable}, State::kLeaving},
    {{State::kDone, Event::kOverdue}, State::kLeaving},
    {{State::kStopped, Event::kUnstable}, State::kLeaving},
    {{State::kStopped, Event::kOverdue}, State::kLeaving},
    {{State::kSearch, Event::kClear}, State::kRewinding},
};

bool rests(State state) {
  return state == State::kIdle || state == State::kLeaving || state == State::kDone ||
         state == State::kStopped;
}

// While an execution is under way; at the target the hand is not at the start.
bool may_be_at_start(State state) { return !rests(state) && state != State::kTracking; }

State demanded(State state, Event event) {
  if (rests(state) && event == Event::kBegin) return State::kWaiting;
  if (rests(state) && event == Event::kBeginAway) return State::kRewindWaiting;
  const auto found = kDemanded.find({state, event});
  if (found != kDemanded.end()) return found->second;
  if (rests(state)) return state;
  if (event == Event::kMissing) return may_be_at_start(state) ? State::kSearch : state;
  const bool waits = published(state) == ExecutionState::kWaiting;
  if (event == Event::kTimeUp || event == Event::kPreempted) return State::kStopped;
  const bool given_up = event == Event::kLost || event == Event::kGiveUp;
  return given_up && !waits ? State::kStopped : state;
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

// Fault 31: HMM chatters at a threshold -> at most one change per dwell time
TEST(DecisionFsm, LetsOnlyTheHmmWaitForTheDwellTime) {
  const std::set<Event> from_hmm{Event::kCalm, Event::kUnsteady, Event::kUnstable};
  for (const Row& row : kTable) {
    const bool waits = from_hmm.count(row.event) == 1 && row.from != State::kWaiting;
    EXPECT_EQ(row.condition == Condition::kDwelled, waits)
        << name(row.from) << " + " << name(row.event);
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

TEST(DecisionFsm, EndsAnExecutionUntilANewGoalAndLeavesTheTargetMeanwhile) {
  for (const State state : kAllStates) EXPECT_EQ(is_resting(state), rests(state)) << name(state);
  for (const Event event : kAllEvents) {
    const bool begins = event == Event::kBegin || event == Event::kBeginAway;
    for (const State state : kAllStates) {
      if (!rests(state)) continue;
      EXPECT_EQ(rests(step(state, event, true)), !begins) << name(state) << " + " << name(event);
    }
  }
}

// In this order of danger, no event leads to a bolder state than the one before it.
TEST(DecisionFsm, GetsNoBolderAsDangerGrows) {
  const std::array danger{Event::kCalm, Event::kUnsteady, Event::kHazard, Event::kUnstable,
                          Event::kOverdue};
  for (const State state : kAllStates) {
    int boldest = 2;
    for (const Event event : danger) {
      const int after = boldness(step(state, event, true));
      EXPECT_LE(after, boldest) << name(state) << " + " << name(event);
      boldest = after;
    }
  }
}

// A target out of sight never makes the hand go on, and only what sees it again ends the search
// before the execution ends.
TEST(DecisionFsm, SearchesFromEveryStateThatCanBeAtTheStartAndLeavesWhenItSees) {
  for (const State state : kAllStates) {
    const State next = step(state, Event::kMissing, true);
    EXPECT_EQ(next != state, may_be_at_start(state) && state != State::kSearch) << name(state);
    if (may_be_at_start(state)) {
      EXPECT_LE(boldness(next), boldness(step(state, Event::kOverdue, true))) << name(state);
    }
  }
  for (const Event event : kAllEvents) {
    const State next = step(State::kSearch, event, true);
    EXPECT_TRUE(next == State::kSearch || next == State::kStopped || event == Event::kClear)
        << name(event);
  }
}

// Whatever makes the hand pause outside makes it leave the target when it lasts: overdue.
TEST(DecisionFsm, LeavesEveryStateAtTheTargetWhenAHazardLasts) {
  for (const State state : kAllStates) {
    if (state == State::kIdle) continue;  // at the start, or before the first goal
    EXPECT_EQ(boldness(step(state, Event::kOverdue, true)), 0) << name(state);
    if (boldness(state) == 0) {
      EXPECT_EQ(step(state, Event::kHazard, true), state) << name(state);
    }
  }
}

// The way back before an execution ends at the start only, or with the execution.
TEST(DecisionFsm, LeavesTheRewindingStatesOnlyAtTheStartOrToStop) {
  for (const State state : kAllStates) {
    if (!is_rewinding(state)) continue;
    for (const Event event : kAllEvents) {
      const State next = step(state, event, true);
      const bool at_start = event == Event::kAtStart || event == Event::kMissing;
      EXPECT_TRUE(is_rewinding(next) || next == State::kStopped || at_start)
          << name(state) << " + " << name(event);
      if (event == Event::kAtStart) {
        EXPECT_EQ(published(next), published(state));
      }
    }
  }
}

TEST(DecisionFsm, PublishesEveryStateOfTheMessage) {
  std::set<ExecutionState> shown;
  for (const State state : kAllStates) shown.insert(published(state));
  EXPECT_EQ(shown.size(), kExecutionStates);
  EXPECT_EQ(published(State::kIdle), ExecutionState::kWaiting);
  EXPECT_EQ(published(State::kLeaving), ExecutionState::kRetract);
  EXPECT_EQ(published(State::kRewinding), ExecutionState::kReverse);
}

TEST(ExecutionFsm, KeepsSinceWhenAndWhyWhereThePublishedStateStays) {
  const Duration dwell = from_seconds(0.3);
  ExecutionFsm fsm;
  EXPECT_TRUE(fsm.can_begin());
  fsm.begin(from_seconds(10), true);
  EXPECT_FALSE(fsm.can_begin());
  EXPECT_TRUE(fsm.fire(from_seconds(10), Event::kClear, "back", dwell));
  EXPECT_EQ(fsm.describe(), "rewinding (reverse) since 10.00 s by clear: back");
  EXPECT_TRUE(fsm.fire(from_seconds(10.2), Event::kAtStart, "there", dwell));
  EXPECT_EQ(fsm.describe(), "reverse (reverse) since 10.00 s by clear: back");
  EXPECT_FALSE(fsm.fire(from_seconds(10.29), Event::kCalm, "", dwell));
  EXPECT_TRUE(fsm.fire(from_seconds(10.3), Event::kCalm, "", dwell));
  EXPECT_EQ(fsm.describe(), "forward (forward) since 10.30 s by calm");
  fsm.explain("not while it moves forward");
  EXPECT_EQ(fsm.reason(), "");
}

TEST(ExecutionFsm, DoesNotCountTheBeginningOfAHazardWhenTheTargetIsUnstable) {
  const Duration dwell = from_seconds(0.3);
  ExecutionFsm fsm;
  fsm.begin(from_seconds(10), false);
  EXPECT_TRUE(fsm.fire(from_seconds(10), Event::kCalm, "", dwell));
  EXPECT_TRUE(fsm.fire(from_seconds(11), Event::kHazard, "too fast", dwell));
  EXPECT_FALSE(fsm.fire(from_seconds(11.1), Event::kCalm, "", dwell));
  EXPECT_TRUE(fsm.fire(from_seconds(11.1), Event::kUnstable, "", dwell));
  EXPECT_EQ(fsm.state(), State::kReverse);
}

TEST(DecisionFsm, PrintsEveryRowInBothForms) {
  const auto count = [](const std::string& text, const std::string& part) {
    std::size_t number = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++number;
    return number;
  };
  const std::string markdown = fsm_markdown();
  const std::string dot = fsm_dot();
  EXPECT_EQ(count(markdown, "\n"), kStates + 2);
  EXPECT_EQ(count(markdown, " → "), kTable.size() + 1);
  EXPECT_NE(markdown.find("| tracking | tracking | unstable [dwelled] → retract, "),
            std::string::npos);
  EXPECT_NE(markdown.find("| rewinding | reverse | at start → reverse, "), std::string::npos);
  EXPECT_EQ(count(dot, " -> "), kTable.size());
  EXPECT_NE(dot.find("tracking -> done [label=\"held\"];"), std::string::npos);
}

}  // namespace
}  // namespace prf_decision
