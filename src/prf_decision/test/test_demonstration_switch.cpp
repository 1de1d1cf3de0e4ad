// SPDX-License-Identifier: BSD-3-Clause
// Orders that name another demonstration.
#include "prf_decision/demonstration_switch.hpp"

#include <gtest/gtest.h>

#include "decision_world.hpp"

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

Order order_of(const std::string& demonstration) { return {{}, {}, false, demonstration}; }

struct DemonstrationSwitchs : testing::Test {
  DemonstrationSwitchs() { world.others["side"] = side_skill(); }

  World world;
};

TEST_F(DemonstrationSwitchs, GoBackAlongTheSkillBeforeThenToTheStartOfTheNewOneThenForward) {
  world.until(State::kDone, 4);
  world.decision().begin(order_of("side"));
  EXPECT_FALSE(world.decision().can_begin());
  const Progress asked = world.tick().progress;
  EXPECT_EQ(asked.state, State::kDone);  // goes on tracking until the planner has answered
  EXPECT_EQ(asked.demonstration.name, "side");
  EXPECT_EQ(asked.demonstration.number, 1u);
  EXPECT_EQ(asked.frozen, 0u);
  world.until(State::kReverse, 0.1);
  bool was_at_old_start = false;
  Outcome outcome = world.tick();
  for (; outcome.progress.state == State::kReverse; outcome = world.tick()) {
    const Eigen::Vector3d& hand = outcome.setpoint->pose.position;
    if (!was_at_old_start) {
      EXPECT_NEAR(hand.y(), 0, 1e-9);
    }
    was_at_old_start = was_at_old_start || (hand - Eigen::Vector3d(0.3, 0, 0.5)).norm() < 0.01;
  }
  EXPECT_TRUE(was_at_old_start);
  EXPECT_EQ(outcome.progress.state, State::kForward);
  EXPECT_LT(outcome.progress.cursor, 0.2);
  EXPECT_LT((outcome.setpoint->pose.position - Eigen::Vector3d(0.3, 0.2, 0.5)).norm(), 0.03);
  EXPECT_EQ(outcome.progress.frozen, 2u);
  const Outcome done = world.until(State::kDone, 4);
  EXPECT_LT((done.setpoint->pose.position - Eigen::Vector3d(0.6, 0.1, 0.5)).norm(), 1e-6);
}

TEST_F(DemonstrationSwitchs, BeginAtOnceWhereNothingWasExecuted) {
  DecisionParams parameters = usual_params();
  parameters.autostart = false;
  World idle(parameters);
  idle.others["side"] = side_skill();
  idle.hand = pose_at(0.3, 0.15, 0.5);
  idle.run(0.2);
  idle.decision().begin(order_of("side"));
  Outcome outcome = idle.tick();
  for (; outcome.progress.state != State::kForward; outcome = idle.tick()) {
    if (outcome.setpoint) {
      EXPECT_GE(outcome.setpoint->pose.position.y(), 0.15 - 1e-9);
    }
    ASSERT_LT(outcome.progress.stamp, from_seconds(53));
    EXPECT_EQ(outcome.progress.cursor, 0);
  }
}

TEST_F(DemonstrationSwitchs, LeaveWhatWasBeforeWhenRefused) {
  world.until(State::kDone, 4);
  world.decision().begin(order_of("missing"));
  Progress progress = world.tick().progress;
  while (progress.refusal.empty() && world.decision().is_asking()) progress = world.tick().progress;
  EXPECT_EQ(progress.refusal, "no such file");
  EXPECT_EQ(progress.state, State::kDone);
  EXPECT_EQ(progress.demonstration.name, "");
  EXPECT_EQ(progress.demonstration.number, 0u);
  progress = world.tick().progress;
  EXPECT_EQ(progress.refusal, "");
  EXPECT_EQ(progress.frozen, 11u);
  EXPECT_TRUE(world.decision().can_begin());
  world.decision().begin({});
  world.until(State::kForward, 3);
  EXPECT_LT(world.until(State::kDone, 4).setpoint->pose.position.y(), 1e-6);
}

TEST_F(DemonstrationSwitchs, AreRefusedWhenThePlannerDoesNotAnswerInTime) {
  world.until(State::kDone, 4);
  world.answers = false;
  world.decision().begin(order_of("side"));
  world.run(4.9);
  EXPECT_TRUE(world.decision().is_asking());
  Progress progress = world.tick().progress;
  for (int i = 0; i < 20 && progress.refusal.empty(); ++i) progress = world.tick().progress;
  EXPECT_EQ(progress.refusal, "the planner did not answer within 5.00 s");
  EXPECT_EQ(progress.demonstration.name, "");
}

TEST_F(DemonstrationSwitchs, AreWithdrawnWhenPreempted) {
  world.until(State::kDone, 4);
  world.answers = false;
  world.decision().begin(order_of("side"));
  world.run(0.1);
  world.decision().preempt();
  const Progress progress = world.tick().progress;
  EXPECT_EQ(progress.refusal, "preempted");
  EXPECT_EQ(progress.state, State::kDone);
  EXPECT_TRUE(world.decision().can_begin());
}

TEST_F(DemonstrationSwitchs, WaitForAPlanOfTheNewDemonstration) {
  world.until(State::kDone, 4);
  world.others["side"] = nullptr;
  world.decision().begin(order_of("side"));
  const Outcome waiting = world.run(1);
  EXPECT_EQ(waiting.progress.state, State::kWaiting);
  EXPECT_EQ(waiting.progress.reason, "no plan yet: no solution");
  EXPECT_EQ(waiting.progress.cursor, 10);
  world.others["side"] = side_skill();
  world.until(State::kReverse, 0.1);
  world.until(State::kForward, 4);
}

TEST_F(DemonstrationSwitchs, AreCompletedByTheNextOrderWhenStoppedOnTheWayBack) {
  world.until(State::kDone, 4);
  world.decision().begin(order_of("side"));
  world.until(State::kReverse, 0.1);
  world.run(0.3);
  world.decision().preempt();
  EXPECT_EQ(world.tick().progress.state, State::kStopped);
  world.decision().begin({{}, {}, true});
  EXPECT_EQ(world.tick().progress.state, State::kReverse);
  world.until(State::kForward, 4);
  EXPECT_NEAR(world.until(State::kDone, 4).setpoint->pose.position.y(), 0.1, 1e-6);
}

// As a planner that is started anew, and finds the file gone.
TEST_F(DemonstrationSwitchs, PauseWhenThePlannerCannotFollowAnyLonger) {
  world.until(State::kDone, 4);
  world.decision().begin(order_of("side"));
  world.until(State::kReverse, 0.1);
  world.until(State::kForward, 4);
  world.run(0.3);
  world.others.clear();
  const Outcome pause = world.until(State::kPause, 0.1);
  EXPECT_EQ(pause.progress.reason, "planner has no plan: no such file");
  EXPECT_EQ(pause.progress.demonstration.name, "side");
  world.others["side"] = side_skill();
  world.until(State::kForward, 0.5);
}

// As a planner that is started anew, and plans without what was executed. World checks the jump.
TEST_F(DemonstrationSwitchs, DoNotJumpWithAPlannerStartedAnew) {
  world.until(State::kDone, 4);
  world.decision().begin(order_of("side"));
  world.until(State::kReverse, 0.1);
  world.until(State::kForward, 4);
  world.run(0.4);
  world.answers = false;
  world.plan_stale = true;
  EXPECT_EQ(world.run(0.5).progress.state, State::kPause);
  Trajectory anew = *side_skill();
  for (Pose& pose : anew.poses) pose.position.z() += 0.05;
  world.others["side"] = std::make_shared<Trajectory>(anew);
  world.answers = true;
  world.plan_stale = false;
  world.until(State::kForward, 0.5);
  EXPECT_NEAR(world.run(0.5).setpoint->pose.position.z(), 0.55, 0.02);
}

TEST_F(DemonstrationSwitchs, NumberEveryNamingSoThatAFileIsReadAnew) {
  world.until(State::kDone, 4);
  for (std::uint32_t number = 1; number <= 2; ++number) {
    world.decision().begin(order_of("side"));
    world.until(State::kReverse, 0.1);
    world.until(State::kForward, 5);
    EXPECT_EQ(world.until(State::kDone, 4).progress.demonstration.number, number);
  }
  EXPECT_THROW(world.decision().begin({{}, {}, true, "side"}), std::invalid_argument);
}

}  // namespace
}  // namespace prf_decision
