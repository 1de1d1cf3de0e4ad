// SPDX-License-Identifier: BSD-3-Clause
// Goals that name another demonstration.
#include "prf_decision/demonstration_switch.hpp"

#include <gtest/gtest.h>

#include "executive/executive_world.hpp"

namespace prf_decision {
namespace {

// Beside the straight skill, ends 0.1 m beside its end.
std::shared_ptr<const Trajectory> side_skill() {
  auto skill = std::make_shared<Trajectory>(straight_skill());
  for (std::size_t i = 0; i < skill->poses.size(); ++i) {
    skill->poses[i].position.y() = 0.2 - 0.01 * static_cast<double>(i);
  }
  skill->goal_in_target = pose_at(-0.4, 0.1, 0);
  return skill;
}

SkillGoal goal_for(const std::string& demonstration) { return {{}, {}, false, demonstration}; }

struct DemonstrationSwitching : testing::Test {
  DemonstrationSwitching() { world.others["side"] = side_skill(); }

  World world;
};

TEST_F(DemonstrationSwitching, GoBackAlongTheSkillBeforeThenToTheStartOfTheNewOneThenForward) {
  world.until(ExecutionState::kDone, 4);
  world.executive().begin(goal_for("side"));
  EXPECT_FALSE(world.executive().can_begin());
  const Progress requested = world.tick().progress;
  EXPECT_EQ(requested.state,
            ExecutionState::kDone);  // goes on tracking until the planner has answered
  EXPECT_EQ(requested.demonstration.name, "side");
  EXPECT_EQ(requested.demonstration.number, 1u);
  EXPECT_EQ(requested.frozen, 0u);
  world.until(ExecutionState::kReverse, 0.1);
  bool was_at_old_start = false;
  ExecutiveResult result = world.tick();
  for (; result.progress.state == ExecutionState::kReverse; result = world.tick()) {
    const Eigen::Vector3d& hand = result.setpoint->pose.position;
    if (!was_at_old_start) {
      EXPECT_NEAR(hand.y(), 0, 1e-9);
    }
    was_at_old_start = was_at_old_start || (hand - Eigen::Vector3d(0.3, 0, 0.5)).norm() < 0.01;
  }
  EXPECT_TRUE(was_at_old_start);
  EXPECT_EQ(result.progress.state, ExecutionState::kForward);
  EXPECT_LT(result.progress.cursor, 0.2);
  EXPECT_LT((result.setpoint->pose.position - Eigen::Vector3d(0.3, 0.2, 0.5)).norm(), 0.03);
  EXPECT_EQ(result.progress.frozen, 2u);
  const ExecutiveResult done = world.until(ExecutionState::kDone, 4);
  EXPECT_LT((done.setpoint->pose.position - Eigen::Vector3d(0.6, 0.1, 0.5)).norm(), 1e-6);
}

TEST_F(DemonstrationSwitching, BeginAtOnceWhereNothingWasExecuted) {
  DecisionParams parameters = usual_params();
  parameters.autostart = false;
  World idle(parameters);
  idle.others["side"] = side_skill();
  idle.hand = pose_at(0.3, 0.15, 0.5);
  idle.run(0.2);
  idle.executive().begin(goal_for("side"));
  ExecutiveResult result = idle.tick();
  int setpoints = 0;
  for (; result.progress.state != ExecutionState::kForward; result = idle.tick()) {
    if (result.setpoint) {
      ++setpoints;
      EXPECT_GE(result.setpoint->pose.position.y(), 0.15 - 1e-9);
    }
    ASSERT_LT(result.progress.stamp, from_seconds(53));
    EXPECT_EQ(result.progress.cursor, 0);
  }
  EXPECT_GE(setpoints, 15);  // 0.05 m at 0.2 m/s, the last 0.02 m count as there
}

TEST_F(DemonstrationSwitching, LeaveWhatWasBeforeWhenRefused) {
  world.until(ExecutionState::kDone, 4);
  world.executive().begin(goal_for("missing"));
  Progress progress = world.tick().progress;
  while (progress.refusal.empty() && world.executive().is_requesting())
    progress = world.tick().progress;
  EXPECT_EQ(progress.refusal, "no such file");
  EXPECT_EQ(progress.state, ExecutionState::kDone);
  EXPECT_EQ(progress.demonstration.name, "");
  EXPECT_EQ(progress.demonstration.number, 0u);
  progress = world.tick().progress;
  EXPECT_EQ(progress.refusal, "");
  EXPECT_EQ(progress.frozen, 11u);
  EXPECT_TRUE(world.executive().can_begin());
  world.executive().begin({});
  world.until(ExecutionState::kForward, 3);
  EXPECT_LT(world.until(ExecutionState::kDone, 4).setpoint->pose.position.y(), 1e-6);
}

TEST_F(DemonstrationSwitching, AreRefusedWhenThePlannerDoesNotAnswerInTime) {
  world.until(ExecutionState::kDone, 4);
  world.planner_answers = false;
  world.executive().begin(goal_for("side"));
  world.run(4.9);
  EXPECT_TRUE(world.executive().is_requesting());
  Progress progress = world.tick().progress;
  for (int i = 0; i < 20 && progress.refusal.empty(); ++i) progress = world.tick().progress;
  EXPECT_EQ(progress.refusal, "the planner did not answer within 5.00 s");
  EXPECT_EQ(progress.demonstration.name, "");
}

TEST_F(DemonstrationSwitching, EndWhenPreempted) {
  world.until(ExecutionState::kDone, 4);
  world.planner_answers = false;
  world.executive().begin(goal_for("side"));
  world.run(0.1);
  world.executive().preempt();
  const Progress progress = world.tick().progress;
  EXPECT_EQ(progress.refusal, "preempted");
  EXPECT_EQ(progress.state, ExecutionState::kDone);
  EXPECT_TRUE(world.executive().can_begin());
}

TEST_F(DemonstrationSwitching, WaitForAPlanOfTheNewDemonstration) {
  world.until(ExecutionState::kDone, 4);
  world.others["side"] = nullptr;
  world.executive().begin(goal_for("side"));
  const ExecutiveResult waiting = world.run(1);
  EXPECT_EQ(waiting.progress.state, ExecutionState::kWaiting);
  EXPECT_EQ(waiting.progress.reason, "no plan yet: no solution");
  EXPECT_EQ(waiting.progress.cursor, 10);
  world.others["side"] = side_skill();
  world.until(ExecutionState::kReverse, 0.1);
  world.until(ExecutionState::kForward, 4);
}

TEST_F(DemonstrationSwitching, AreCompletedByTheNextGoalWhenStoppedOnTheWayBack) {
  world.until(ExecutionState::kDone, 4);
  world.executive().begin(goal_for("side"));
  world.until(ExecutionState::kReverse, 0.1);
  world.run(0.3);
  world.executive().preempt();
  EXPECT_EQ(world.tick().progress.state, ExecutionState::kStopped);
  world.executive().begin({{}, {}, true});
  EXPECT_EQ(world.tick().progress.state, ExecutionState::kReverse);
  world.until(ExecutionState::kForward, 4);
  EXPECT_NEAR(world.until(ExecutionState::kDone, 4).setpoint->pose.position.y(), 0.1, 1e-6);
}

// As a planner that is restarted and finds the file gone.
TEST_F(DemonstrationSwitching, PauseWhenThePlannerCannotFollowAnyLonger) {
  world.until(ExecutionState::kDone, 4);
  world.executive().begin(goal_for("side"));
  world.until(ExecutionState::kReverse, 0.1);
  world.until(ExecutionState::kForward, 4);
  world.run(0.3);
  world.others.clear();
  const ExecutiveResult pause = world.until(ExecutionState::kPause, 0.1);
  EXPECT_EQ(pause.progress.reason, "planner has no plan: no such file");
  EXPECT_EQ(pause.progress.demonstration.name, "side");
  world.others["side"] = side_skill();
  world.until(ExecutionState::kForward, 0.5);
}

// As a planner that is restarted and plans without the executed nodes. World checks the jump.
TEST_F(DemonstrationSwitching, DoNotJumpWithARestartedPlanner) {
  world.until(ExecutionState::kDone, 4);
  world.executive().begin(goal_for("side"));
  world.until(ExecutionState::kReverse, 0.1);
  world.until(ExecutionState::kForward, 4);
  world.run(0.4);
  world.planner_answers = false;
  world.planner_silent = true;
  EXPECT_EQ(world.run(0.5).progress.state, ExecutionState::kPause);
  Trajectory replanned = *side_skill();
  for (Pose& pose : replanned.poses) pose.position.z() += 0.05;
  world.others["side"] = std::make_shared<Trajectory>(replanned);
  world.planner_answers = true;
  world.planner_silent = false;
  world.until(ExecutionState::kForward, 0.5);
  EXPECT_NEAR(world.run(0.5).setpoint->pose.position.z(), 0.55, 0.02);
}

TEST_F(DemonstrationSwitching, NumberEveryNamingSoThatAFileIsReadAgain) {
  world.until(ExecutionState::kDone, 4);
  for (std::uint32_t number = 1; number <= 2; ++number) {
    world.executive().begin(goal_for("side"));
    world.until(ExecutionState::kReverse, 0.1);
    world.until(ExecutionState::kForward, 5);
    EXPECT_EQ(world.until(ExecutionState::kDone, 4).progress.demonstration.number, number);
  }
  EXPECT_THROW(world.executive().begin({{}, {}, true, "side"}), std::invalid_argument);
}

TEST(DemonstrationSwitch, FollowsItsTableAndStaysOnEveryUnlistedPair) {
  DemonstrationSwitch demonstration;
  EXPECT_EQ(demonstration.receive(0, false), PlanFor::kCurrent);
  demonstration.request("side");
  EXPECT_EQ(demonstration.receive(0, false), PlanFor::kCurrent);
  EXPECT_EQ(demonstration.receive(7, false), PlanFor::kAnotherRequest);
  EXPECT_EQ(demonstration.state(), SwitchState::kRequested);
  EXPECT_EQ(demonstration.receive(1, false), PlanFor::kAccepted);
  EXPECT_EQ(demonstration.state(), SwitchState::kReturning);
  demonstration.request("third");
  EXPECT_EQ(demonstration.state(), SwitchState::kReturningRequested);
  EXPECT_EQ(demonstration.wanted().name, "third");
  EXPECT_EQ(demonstration.receive(2, true), PlanFor::kRefused);
  EXPECT_EQ(demonstration.state(), SwitchState::kReturning);
  EXPECT_EQ(demonstration.wanted().name, "side");
  demonstration.arrive();
  EXPECT_EQ(demonstration.state(), SwitchState::kSettled);
  demonstration.arrive();
  demonstration.end_request();
  EXPECT_EQ(demonstration.state(), SwitchState::kSettled);
}

// A further goal comes while the hand is at the start already and waits for the first plan.
TEST(DemonstrationSwitch, ArrivesWhileAFurtherDemonstrationIsRequested) {
  DemonstrationSwitch demonstration;
  demonstration.request("side");
  EXPECT_EQ(demonstration.receive(1, false), PlanFor::kAccepted);
  demonstration.request("third");
  demonstration.arrive();
  EXPECT_EQ(demonstration.state(), SwitchState::kRequested);
  demonstration.end_request();
  EXPECT_EQ(demonstration.state(), SwitchState::kSettled);
  EXPECT_EQ(demonstration.wanted().name, "side");
}

}  // namespace
}  // namespace prf_decision
