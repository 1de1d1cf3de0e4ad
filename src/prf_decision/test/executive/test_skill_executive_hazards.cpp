// SPDX-License-Identifier: BSD-3-Clause
// Violations of the guards while a skill is executed.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "executive_world.hpp"

namespace prf_decision {
namespace {

// Fault 50: planner silent, goal out of reach, target too fast -> pause, go back when it
// lasts, go on afterwards
TEST(SkillExecutive, GoesBackWhenAnyHazardLastsAndForwardOnceItIsOver) {
  const std::vector<std::function<void(World&, bool)>> catalogue{
      [](World& w, bool on) { w.planner_silent = on; },
      [](World& w, bool on) { w.position.x() = on ? 1.6 : 1.0; },  // goal out of reach
      [](World& w, bool on) { w.velocity.y() = on ? 1.6 : 0.0; },
  };
  for (const auto& hazard : catalogue) {
    for (const bool inside : {false, true}) {
      World world;
      if (inside) world.until(ExecutionState::kTracking, 2);
      if (!inside) world.run(0.6);
      hazard(world, true);
      world.run(0.9);
      EXPECT_LE(world.tick().progress.cursor, 10);
      world.run(2.5);
      EXPECT_EQ(world.tick().progress.cursor, 0);
      EXPECT_EQ(world.tick().progress.state, ExecutionState::kReverse);
      hazard(world, false);
      world.until(ExecutionState::kDone, 5);
    }
  }
}

// Every guard acts in forward while the HMM believes in Forward, and the execution goes on
// afterwards.
// Fault 22: planner has no plan -> pause, the last plan is kept; on once it has one
TEST(SkillExecutive, PausesForEveryHazardWhateverTheHmmBelievesAndGoesOnAfterIt) {
  struct Hazard {
    std::function<void(World&)> begin;
    std::string reason;
  };
  const std::vector<Hazard> catalogue{
      {[](World& w) { w.forecast_silent = true; }, "forecast silent for "},
      {[](World& w) { w.planner_silent = true; }, "planner silent"},
      {[](World& w) { w.plan = nullptr; }, "planner has no plan: no solution"},
      {[](World& w) { w.status = TargetStatus::kNoTarget; }, "predictor has lost the target"},
      {[](World& w) { w.status = TargetStatus::kLost; }, "predictor has lost the target"},
      {[](World& w) { w.status = TargetStatus::kCoasting; }, "no measurement of the target for "},
      {[](World& w) {
         w.position = {2.5, 0, 0.5};
       },
       "forecast 2.51 m from the shoulder"},
      {[](World& w) {
         w.position = {1.6, 0, 0.5};
       },
       "goal 1.22 m from the shoulder"},
      {[](World& w) { w.leap(0.31); }, "joint_states silent for 0.32 s"},
      {[](World& w) { w.control_fails = true; }, "the arm controller does not follow: joint 3"},
      {[](World& w) { w.control_silent = true; }, "control/status silent for 0.05 s"},
      {[](World& w) { w.hand_known = false; }, "the measured hand is unknown"},
  };
  for (const auto& [begin, reason] : catalogue) {
    World world;
    world.until(ExecutionState::kForward, 0.1);
    world.run(0.3);
    const auto plan = world.plan;
    begin(world);
    const ExecutiveResult paused = world.until(ExecutionState::kPause, 0.4);
    EXPECT_EQ(paused.progress.reason.rfind(reason, 0), 0u)
        << paused.progress.reason << " for " << reason;
    EXPECT_GT(paused.progress.posterior[0], 0.5);
    world.forecast_silent = world.planner_silent = false;
    world.control_fails = world.control_silent = false;
    world.hand_known = true;
    world.status = TargetStatus::kTracking;
    world.position = kTarget;
    world.plan = plan;
    world.until(ExecutionState::kDone, 4);
  }
}

TEST(SkillExecutive, HoldsWhereItIsWhenAHazardEndsTheTracking) {
  World world;
  world.until(ExecutionState::kTracking, 2);
  const ExecutiveResult before = world.run(0.1);
  world.position = {2.5, 0, 0.5};
  world.until(ExecutionState::kPause, 0.1);
  const ExecutiveResult after = world.run(0.8);
  EXPECT_EQ(after.setpoint->pose.position, before.setpoint->pose.position);
}

TEST(SkillExecutive, KeepsTrackingTheLastBeliefNoLongerThanTheFirstLimitOnceDone) {
  World world;
  const ExecutiveResult done = world.until(ExecutionState::kDone, 5);
  world.status = TargetStatus::kCoasting;
  world.velocity = {0, 0.2, 0};
  const ExecutiveResult held = world.run(0.9);
  EXPECT_EQ(held.progress.state, ExecutionState::kDone);
  EXPECT_EQ(held.setpoint->linear_velocity.norm(), 0);
  EXPECT_EQ(held.progress.reason, done.progress.reason);
}

TEST(SkillExecutive, LeavesTheTargetOnceDoneOrStoppedWhenItIsLostOrUnstable) {
  for (const bool done : {true, false}) {
    for (const bool lost : {true, false}) {
      World world;
      world.until(ExecutionState::kTracking, 2);
      if (done) {
        world.until(ExecutionState::kDone, 2);
      } else {
        world.executive().preempt();
        EXPECT_EQ(world.run(0.5).progress.state, ExecutionState::kStopped);
        world.forget_setpoint();
      }
      if (lost) world.status = TargetStatus::kCoasting;
      if (!lost) world.velocity = {0, 0.7, 0};
      world.until(ExecutionState::kRetract, 1.2);
      EXPECT_FALSE(world.executive().can_begin() == false) << "a goal may begin meanwhile";
      const ExecutiveResult left = world.until(ExecutionState::kWaiting, 3);
      EXPECT_EQ(left.progress.cursor, 0);
    }
  }
}

// A stop half-way is not at the target: the arm stays where it was stopped.
TEST(SkillExecutive, StaysStoppedOutsideWhateverTheTargetDoes) {
  World world;
  world.run(0.4);
  world.executive().preempt();
  world.run(0.5);
  world.velocity = {0, 0.9, 0};
  EXPECT_EQ(world.run(3).progress.state, ExecutionState::kStopped);
  world.status = TargetStatus::kLost;
  EXPECT_EQ(world.run(3).progress.state, ExecutionState::kStopped);
}

// Fault 15: tag lost for T1, T2, T3 -> pause, go back, stopped once the hand is at the start
TEST(SkillExecutive, PausesThenGoesBackThenStopsWhenTheTargetStaysLost) {
  World world;
  world.until(ExecutionState::kForward, 0.1);
  world.run(0.5);
  world.status = TargetStatus::kCoasting;
  world.until(ExecutionState::kPause, 0.4);
  const ExecutiveResult back = world.until(ExecutionState::kReverse, 0.8);
  EXPECT_EQ(back.progress.reason.rfind("no measurement of the target for 1.0", 0), 0u)
      << back.progress.reason;
  EXPECT_GT(back.progress.cursor, 0);
  const ExecutiveResult stopped = world.until(ExecutionState::kStopped, 1.1);
  EXPECT_EQ(stopped.progress.cursor, 0);
  EXPECT_EQ(stopped.progress.reason.rfind("no measurement of the target for 2.0", 0), 0u);
  EXPECT_FALSE(stopped.setpoint);
  world.status = TargetStatus::kTracking;
  EXPECT_EQ(world.run(1).progress.state, ExecutionState::kStopped);
}

TEST(SkillExecutive, DoesNotFollowTheForecastOfALostTargetOnTheApproach) {
  DecisionParams params = usual_params();
  params.reference.approach_length = 0.1;
  World world(params);
  world.until(ExecutionState::kForward, 0.1);
  world.run(0.75);
  world.status = TargetStatus::kLost;
  world.velocity = {0, 0.1, 0};
  world.until(ExecutionState::kPause, 0.1);
  const ExecutiveResult held = world.run(0.8);
  EXPECT_EQ(held.progress.state, ExecutionState::kPause);
  EXPECT_LT(held.setpoint->linear_velocity.norm(), 1e-3);
}

// Fault 10: forecasts fall silent with the hand in the box -> the hand pauses, relative to the
// target as the last forecast has it
TEST(SkillExecutive, MovesOnWithTheLastForecastWhileNoneComes) {
  DecisionParams params = usual_params();
  params.reference.approach_length = 0.1;
  World world(params);
  world.until(ExecutionState::kTracking, 3);
  world.velocity = {0, 0.1, 0};
  world.run(0.1);
  const Eigen::Vector3d before = world.hand.position;
  world.forecast_silent = true;
  const ExecutiveResult result = world.run(0.3);
  EXPECT_EQ(result.progress.state, ExecutionState::kPause);
  EXPECT_NEAR((world.hand.position - before).y(), 0.03, 0.01);
  const ExecutiveResult held = world.run(0.6);  // the forecast reaches 0.5 s ahead
  EXPECT_LT(held.setpoint->linear_velocity.norm(), 1e-3);
}

}  // namespace
}  // namespace prf_decision
