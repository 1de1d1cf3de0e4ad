// SPDX-License-Identifier: BSD-3-Clause
// Executions on demand: begun by an order, preempted in any state.
#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "decision_world.hpp"

namespace prf_decision {
namespace {

DecisionParams on_demand() {
  DecisionParams parameters = usual_params();
  parameters.autostart = false;
  return parameters;
}

constexpr double kSway = 0.6;  // m/s, goes back

// Brings a world with an execution under way into each state.
const std::map<State, std::function<void(World&)>> kWays{
    {State::kWaiting,
     [](World& world) {
       world.status = TargetStatus::kNoTarget;
       world.run(0.2);
     }},
    {State::kForward, [](World& world) { world.run(0.5); }},
    {State::kPause,
     [](World& world) {
       world.run(0.5);
       world.plan_stale = true;
       world.run(0.1);
     }},
    {State::kReverse,
     [](World& world) {
       world.run(0.7);
       world.velocity.x() = kSway;
       world.until(State::kReverse, 3);
     }},
    {State::kTracking, [](World& world) { world.until(State::kTracking, 2); }},
    {State::kRetract,
     [](World& world) {
       world.until(State::kTracking, 2);
       world.velocity.x() = kSway;
       world.until(State::kRetract, 3);
     }},
};

TEST(Preemption, StopsInEveryStateWithinOneTickAndHolds) {
  for (const auto& [state, lead_to] : kWays) {
    World world(on_demand());
    world.decision().begin({});
    lead_to(world);
    ASSERT_EQ(world.tick().progress.state, state);
    world.decision().preempt();
    const Outcome outcome = world.tick();
    EXPECT_EQ(outcome.progress.state, State::kStopped) << name(state);
    EXPECT_EQ(outcome.progress.cause, Event::kPreempted);
    EXPECT_EQ(outcome.progress.reason, "preempted");
    EXPECT_FALSE(outcome.setpoint) << "the arm brakes by itself when there is none";
    EXPECT_EQ(world.run(1).progress.state, State::kStopped);
  }
}

TEST(Preemption, DoesNothingBeforeAnOrderAndAfterTheEnd) {
  World idle(on_demand());
  idle.decision().preempt();
  EXPECT_EQ(idle.tick().progress.state, State::kWaiting);
  idle.decision().begin({});
  EXPECT_EQ(idle.run(0.2).progress.state, State::kForward);

  World done;
  done.until(State::kDone, 4);
  done.decision().preempt();
  EXPECT_EQ(done.tick().progress.state, State::kDone);
}

TEST(Order, IsNeededUnlessTheFirstExecutionStartsByItself) {
  World world(on_demand());
  const Outcome outcome = world.run(1);
  EXPECT_EQ(outcome.progress.state, State::kWaiting);
  EXPECT_EQ(outcome.progress.reason, "no goal yet");
  EXPECT_EQ(outcome.progress.cursor, 0);
  EXPECT_TRUE(world.decision().can_begin());
  EXPECT_FALSE(World().decision().can_begin());
}

TEST(Order, IsRefusedWhileAnExecutionIsUnderWayAndWithNegativeTimes) {
  World world(on_demand());
  EXPECT_THROW(world.decision().begin({from_seconds(-1), {}, false}), std::invalid_argument);
  EXPECT_THROW(world.decision().begin({{}, from_seconds(-1), false}), std::invalid_argument);
  world.decision().begin({});
  EXPECT_THROW(world.decision().begin({}), std::invalid_argument);
  world.run(0.5);
  EXPECT_THROW(world.decision().begin({}), std::invalid_argument);
}

TEST(Order, CountsItsOwnTimeLimitAndHoldTimeFromItsBeginning) {
  World world(on_demand());
  world.run(30);  // more than the time limit
  world.decision().begin({from_seconds(4), from_seconds(0.4), false});
  world.until(State::kTracking, 1.5);
  EXPECT_EQ(world.until(State::kDone, 0.6).progress.reason, "tracked for 0.40 s");

  world.decision().begin({from_seconds(0.3), {}, true});
  world.velocity.x() = 0.01;
  EXPECT_EQ(world.until(State::kStopped, 1).progress.cause, Event::kTimeUp);
}

TEST(Order, GoesBackToTheStartWhateverTheHmmSaysAndThenForward) {
  World world;
  world.until(State::kDone, 4);
  world.decision().begin({});
  Progress progress = world.tick().progress;
  EXPECT_EQ(progress.state, State::kReverse);
  for (double before = 10; progress.state == State::kReverse; before = progress.cursor) {
    progress = world.tick().progress;
    EXPECT_EQ(progress.state, before > 0 ? State::kReverse : State::kForward);
  }
  EXPECT_EQ(world.until(State::kTracking, 3).progress.cursor, 10);
}

TEST(Order, PausesOnTheWayBackForAHazardAndGoesOn) {
  World world;
  world.until(State::kDone, 4);
  world.decision().begin({});
  world.run(0.3);
  world.plan_stale = true;
  const double paused = world.run(0.3).progress.cursor;
  EXPECT_EQ(world.tick().progress.state, State::kPause);
  world.plan_stale = false;
  EXPECT_EQ(world.tick().progress.state, State::kReverse);
  EXPECT_LT(world.tick().progress.cursor, paused);
}

// A decision that was started anew, or an arm that was moved while it held.
TEST(Order, BeginsWhereTheHandIsWithoutAJump) {
  World world;
  world.hand = pose_at(0.5, 0.1, 0.45);
  const Outcome first = world.until(State::kForward, 0.1);
  ASSERT_TRUE(first.setpoint);
  EXPECT_LT((first.setpoint->pose.position - world.hand->position).norm(), 0.006);
  world.run(0.2);
  world.decision().preempt();
  world.tick();
  world.hand = pose_at(0.4, -0.1, 0.45);
  world.run(0.1);
  world.decision().begin({{}, {}, true});
  world.forget_setpoint();
  const Outcome again = world.tick();
  EXPECT_EQ(again.progress.state, State::kForward);
  EXPECT_LT((again.setpoint->pose.position - world.hand->position).norm(), 0.006);
}

TEST(Order, ResumesWhereTheLastExecutionEnded) {
  World world;
  world.run(0.6);
  world.decision().preempt();
  const double cursor = world.tick().progress.cursor;
  world.run(0.5);
  world.decision().begin({{}, {}, true});
  const Outcome outcome = world.tick();
  EXPECT_EQ(outcome.progress.state, State::kForward);
  EXPECT_GT(outcome.progress.cursor, cursor);
}

TEST(Tuning, ActsFromTheNextTickAndIsRefusedWhole) {
  World world;
  world.until(State::kTracking, 2);
  DecisionParams tuned = usual_params();
  tuned.guards.max_target_speed = 0.05;
  tuned.tracking_tolerance = -1;
  EXPECT_THROW(world.decision().tune(tuned), std::invalid_argument);
  world.velocity.x() = 0.1;
  EXPECT_EQ(world.run(0.2).progress.state, State::kTracking);
  tuned.tracking_tolerance = 0.02;
  world.decision().tune(tuned);
  EXPECT_EQ(world.tick().progress.state, State::kPause);
}

TEST(Progress, TellsTheDistanceToTheGoalAndToItsAxis) {
  World world;
  world.position.y() = 0.03;  // the skill still ends at y = 0 and z is the axis: both are off
  const Progress progress = world.until(State::kForward, 0.1).progress;
  ASSERT_TRUE(progress.goal_distance && progress.axis_distance);
  EXPECT_NEAR(*progress.goal_distance, std::hypot(0.3, 0.03), 0.005);
  EXPECT_NEAR(*progress.axis_distance, std::hypot(0.3, 0.03), 0.005);
  EXPECT_NEAR(world.until(State::kTracking, 2).progress.share, 1, 0);
}

}  // namespace
}  // namespace prf_decision
