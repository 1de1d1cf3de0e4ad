// SPDX-License-Identifier: BSD-3-Clause
// Executions on demand: begun by a goal, preempted in any state.
#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "executive_world.hpp"

namespace prf_decision {
namespace {

DecisionParams on_demand() {
  DecisionParams parameters = usual_params();
  parameters.autostart = false;
  return parameters;
}

constexpr double kSway = 0.6;  // m/s, goes back

// Brings a world with an execution under way into each state.
const std::map<ExecutionState, std::function<void(World&)>> kWays{
    {ExecutionState::kWaiting,
     [](World& world) {
       world.status = TargetStatus::kNoTarget;
       world.run(0.2);
     }},
    {ExecutionState::kForward, [](World& world) { world.run(0.5); }},
    {ExecutionState::kPause,
     [](World& world) {
       world.run(0.5);
       world.planner_silent = true;
       world.run(0.1);
     }},
    {ExecutionState::kReverse,
     [](World& world) {
       world.run(0.7);
       world.velocity.x() = kSway;
       world.until(ExecutionState::kReverse, 3);
     }},
    {ExecutionState::kTracking, [](World& world) { world.until(ExecutionState::kTracking, 2); }},
    {ExecutionState::kRetract,
     [](World& world) {
       world.until(ExecutionState::kTracking, 2);
       world.velocity.x() = kSway;
       world.until(ExecutionState::kRetract, 3);
     }},
};

// Fault 33: skill preempted while reversing, or in any state -> stopped within a tick, holds
TEST(Preemption, StopsInEveryStateWithinOneTickAndHolds) {
  for (const auto& [state, lead_to] : kWays) {
    World world(on_demand());
    world.executive().begin({});
    lead_to(world);
    ASSERT_EQ(world.tick().progress.state, state);
    world.executive().preempt();
    const ExecutiveResult result = world.tick();
    EXPECT_EQ(result.progress.state, ExecutionState::kStopped) << name(state);
    EXPECT_EQ(result.progress.cause, Event::kPreempted);
    EXPECT_EQ(result.progress.reason, "preempted");
    EXPECT_FALSE(result.setpoint) << "the arm brakes by itself when there is none";
    EXPECT_EQ(world.run(1).progress.state, ExecutionState::kStopped);
  }
}

TEST(Preemption, DoesNothingBeforeAGoalAndAfterTheEnd) {
  World idle(on_demand());
  idle.executive().preempt();
  EXPECT_EQ(idle.tick().progress.state, ExecutionState::kWaiting);
  idle.executive().begin({});
  EXPECT_EQ(idle.run(0.2).progress.state, ExecutionState::kForward);

  World done;
  done.until(ExecutionState::kDone, 4);
  done.executive().preempt();
  EXPECT_EQ(done.tick().progress.state, ExecutionState::kDone);
}

TEST(SkillGoal, IsNeededUnlessTheFirstExecutionStartsByItself) {
  World world(on_demand());
  const ExecutiveResult result = world.run(1);
  EXPECT_EQ(result.progress.state, ExecutionState::kWaiting);
  EXPECT_EQ(result.progress.reason, "no goal yet");
  EXPECT_EQ(result.progress.cursor, 0);
  EXPECT_TRUE(world.executive().can_begin());
  EXPECT_FALSE(World().executive().can_begin());
}

TEST(SkillGoal, IsRefusedWhileAnExecutionIsUnderWayAndWithNegativeTimes) {
  World world(on_demand());
  EXPECT_THROW(world.executive().begin({from_seconds(-1), {}, false}), std::invalid_argument);
  EXPECT_THROW(world.executive().begin({{}, from_seconds(-1), false}), std::invalid_argument);
  world.executive().begin({});
  EXPECT_THROW(world.executive().begin({}), std::invalid_argument);
  world.run(0.5);
  EXPECT_THROW(world.executive().begin({}), std::invalid_argument);
}

TEST(SkillGoal, CountsItsOwnTimeLimitAndHoldTimeFromItsBeginning) {
  World world(on_demand());
  world.run(30);  // more than the time limit
  world.executive().begin({from_seconds(4), from_seconds(0.4), false});
  world.until(ExecutionState::kTracking, 1.5);
  EXPECT_EQ(world.until(ExecutionState::kDone, 0.6).progress.reason, "tracked for 0.40 s");

  world.executive().begin({from_seconds(0.3), {}, true});
  world.velocity.x() = 0.01;
  EXPECT_EQ(world.until(ExecutionState::kStopped, 1).progress.cause, Event::kTimeUp);
}

TEST(SkillGoal, GoesBackToTheStartWhateverTheHmmSaysAndThenForward) {
  World world;
  world.until(ExecutionState::kDone, 4);
  world.executive().begin({});
  Progress progress = world.tick().progress;
  EXPECT_EQ(progress.state, ExecutionState::kReverse);
  for (double before = 10; progress.state == ExecutionState::kReverse; before = progress.cursor) {
    progress = world.tick().progress;
    EXPECT_EQ(progress.state, before > 0 ? ExecutionState::kReverse : ExecutionState::kForward);
  }
  EXPECT_EQ(world.until(ExecutionState::kTracking, 3).progress.cursor, 10);
}

TEST(SkillGoal, GoesOnBackWhateverTheHazard) {
  World world;
  world.until(ExecutionState::kDone, 4);
  world.executive().begin({});
  world.run(0.3);
  world.planner_silent = world.forecast_silent = true;
  world.run(1.5);
  EXPECT_EQ(world.tick().progress.cursor, 0);
  world.planner_silent = world.forecast_silent = false;
  world.until(ExecutionState::kDone, 5);
}

// Fault 26: decision restarted, or an arm moved while it held -> begins where the hand is, no jump
TEST(SkillGoal, BeginsWhereTheHandIsWithoutAJump) {
  World world;
  world.hand = pose_at(0.35, 0.05, 0.45);
  const Pose hand = world.hand;
  const ExecutiveResult first = world.until(ExecutionState::kForward, 0.1);
  ASSERT_TRUE(first.setpoint);
  EXPECT_LT((first.setpoint->pose.position - hand.position).norm(), 0.006);
}

// Fault 47: execution begins away from the start of the skill -> first to the start, slowly
TEST(SkillGoal, GoesToTheStartFirstWhenTheHandIsElsewhere) {
  for (const bool resume : {false, true}) {
    World world;
    if (resume) {
      world.run(0.6);
      world.executive().preempt();
      world.tick();
    }
    world.hand = pose_at(0.5, 0.2, 0.45);
    world.forget_setpoint();
    if (resume) world.executive().begin({{}, {}, true});
    world.until(ExecutionState::kReverse, 0.2);
    for (ExecutiveResult result = world.tick();
         result.progress.state == ExecutionState::kReverse;) {
      const Eigen::Vector3d before = world.hand.position;
      result = world.tick();
      if (result.progress.cursor > 0) continue;
      EXPECT_LT((world.hand.position - before).norm(), 0.2 * to_seconds(kTickPeriod) + 1e-9);
    }
    EXPECT_LT((world.hand.position - Eigen::Vector3d(0.3, 0, 0.5)).norm(), 0.03);
    EXPECT_LT(world.tick().progress.cursor, 0.5);
    world.until(ExecutionState::kDone, 4);
  }
}

TEST(SkillGoal, TurnsToTheTargetOnTheWayToTheStart) {
  DecisionParams params = usual_params();
  params.reference.view_angle = 0.05;
  World world(params);
  world.hand = pose_at(0.5, 0.4, 0.45);
  const auto off = [&world]() {
    const Eigen::Vector3d sight = world.position - world.hand.position;
    return std::acos((world.hand.orientation.conjugate() * sight.normalized()).x());
  };
  double before = off();
  EXPECT_GT(before, 0.5);
  world.until(ExecutionState::kReverse, 0.2);
  while (world.tick().progress.state == ExecutionState::kReverse) {
    ASSERT_LT(off(), std::max(before, 0.06));
    before = off();
  }
  EXPECT_LT(off(), 0.06);
  world.until(ExecutionState::kDone, 6);
  EXPECT_LT(world.hand.orientation.angularDistance(Eigen::Quaterniond::Identity()), 0.05);
}

// Fault 47: target out of view on the way to the start -> goes on to the start, waits there for
// coast_limits[2], and only then gives up
TEST(SkillGoal, GoesToTheStartThoughTheTargetIsOutOfViewMeanwhile) {
  for (const bool seen_again : {false, true}) {
    World world;
    world.hand = pose_at(0.5, 0.9, 0.45);  // 4.6 s at 0.2 m/s, stop_after is 2 s
    world.until(ExecutionState::kReverse, 0.2);
    world.status = TargetStatus::kCoasting;
    EXPECT_EQ(world.run(4.3).progress.state, ExecutionState::kReverse);
    EXPECT_EQ(world.run(2.0).progress.state, ExecutionState::kReverse);
    EXPECT_LT((world.hand.position - Eigen::Vector3d(0.3, 0, 0.5)).norm(), 0.03);
    if (seen_again) world.status = TargetStatus::kTracking;
    world.until(seen_again ? ExecutionState::kForward : ExecutionState::kStopped, 1);
  }
}

TEST(SkillGoal, ResumesWhereTheLastExecutionEnded) {
  World world;
  world.run(0.6);
  world.executive().preempt();
  const double cursor = world.tick().progress.cursor;
  world.run(0.5);
  world.executive().begin({{}, {}, true});
  const ExecutiveResult result = world.tick();
  EXPECT_EQ(result.progress.state, ExecutionState::kForward);
  EXPECT_GT(result.progress.cursor, cursor);
}

// Fault 29: reconfigured while running -> whole or not at all
TEST(Tuning, ActsFromTheNextTickAndIsRefusedWhole) {
  World world;
  world.until(ExecutionState::kTracking, 2);
  DecisionParams tuned = usual_params();
  tuned.guards.max_target_speed = 0.05;
  tuned.reference.tracking_tolerance = -1;
  EXPECT_THROW(world.executive().tune(tuned), std::invalid_argument);
  world.velocity.x() = 0.1;
  EXPECT_EQ(world.run(0.2).progress.state, ExecutionState::kTracking);
  tuned.reference.tracking_tolerance = 0.02;
  world.executive().tune(tuned);
  EXPECT_EQ(world.tick().progress.state, ExecutionState::kPause);
}

TEST(Progress, TellsTheDistanceToTheGoalAndToItsAxis) {
  World world;
  world.position.y() = 0.03;  // the skill still ends at y = 0 and z is the axis: both are off
  const Progress progress = world.until(ExecutionState::kForward, 0.1).progress;
  ASSERT_TRUE(progress.goal_distance);
  EXPECT_NEAR(progress.goal_distance->distance, std::hypot(0.3, 0.03), 0.005);
  EXPECT_NEAR(progress.goal_distance->axis, std::hypot(0.3, 0.03), 0.005);
  EXPECT_EQ(world.until(ExecutionState::kTracking, 2).progress.fraction, 1);
}

}  // namespace
}  // namespace prf_decision
