// SPDX-License-Identifier: BSD-3-Clause
// An arm that does not do what it is asked to.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "executive_world.hpp"

namespace prf_decision {
namespace {

// Fault 39: hand blocked on the way -> pause, the cursor waits, back, given up; never done
TEST(SkillExecutive, PausesGoesBackAndGivesUpWhenTheHandIsBlocked) {
  World world;
  world.until(ExecutionState::kForward, 0.1);
  world.run(0.6);  // 0.18 m from the start
  world.arm_follows = false;
  const ExecutiveResult paused = world.until(ExecutionState::kPause, 0.8);
  EXPECT_EQ(paused.progress.reason.rfind("hand 0.1", 0), 0u) << paused.progress.reason;
  ASSERT_TRUE(paused.progress.following);
  EXPECT_GT(paused.progress.following->position, 0.1);
  EXPECT_LT(paused.progress.following->position, 0.1 + 0.3 * 0.12);
  EXPECT_EQ(world.run(0.5).progress.cursor, paused.progress.cursor);
  const ExecutiveResult back = world.until(ExecutionState::kReverse, 0.6);
  // Back as far as the hand, no farther: the set-point does not leave it behind.
  for (int i = 0; i < 300; ++i) {
    const ExecutiveResult result = world.tick();
    if (!result.setpoint) continue;
    EXPECT_LT((result.setpoint->pose.position - world.hand.position).norm(), 0.15);
  }
  EXPECT_LT(world.tick().progress.cursor, back.progress.cursor);
}

TEST(SkillExecutive, GivesUpWhenTheHandIsHeldAwayFromTheWholeSkill) {
  World world;
  world.until(ExecutionState::kForward, 0.1);
  world.run(0.3);
  world.arm_follows = false;
  world.hand = pose_at(0.4, 0.3, 0.5);
  world.until(ExecutionState::kPause, 0.2);
  world.until(ExecutionState::kReverse, 1.1);
  const ExecutiveResult stopped = world.until(ExecutionState::kStopped, 4.2);
  EXPECT_EQ(stopped.progress.cause, Event::kGiveUp);
  EXPECT_NE(stopped.progress.reason.find(" from its set-point"), std::string::npos);
  EXPECT_FALSE(stopped.setpoint);
}

// Fault 39: arm thrown to and fro, never off for long -> given up all the same, not at the limit
TEST(SkillExecutive, GivesUpAnArmThatIsOffAgainAndAgain) {
  World world;
  world.until(ExecutionState::kForward, 0.1);
  world.arm_follows = false;
  int ticks = 0;
  ExecutiveResult result = world.tick();
  for (; ticks < 2000 && result.progress.state != ExecutionState::kStopped; ++ticks) {
    const bool off = ticks % 60 < 30;  // 0.3 s off, 0.3 s not
    if (result.setpoint) world.hand = result.setpoint->pose;
    if (off) world.hand.position.y() += 0.15;
    result = world.tick();
  }
  EXPECT_EQ(result.progress.cause, Event::kGiveUp) << result.progress.reason;
  EXPECT_NE(result.progress.reason.find("off again and again"), std::string::npos);
  EXPECT_GT(ticks, 500);
  EXPECT_LT(ticks, 1000);
}

// Now and then an arm may be late without harm.
TEST(SkillExecutive, DoesNotGiveUpAnArmThatIsSeldomOff) {
  World world;
  world.until(ExecutionState::kForward, 0.1);
  world.arm_follows = false;
  ExecutiveResult result = world.tick();
  for (int ticks = 0; ticks < 1900; ++ticks) {
    if (result.setpoint) world.hand = result.setpoint->pose;
    if (ticks % 200 < 10) world.hand.position.y() += 0.15;
    result = world.tick();
    ASSERT_NE(result.progress.state, ExecutionState::kStopped) << result.progress.reason;
  }
}

// Fault 38: controller dead, failing, or hand unknown during execution -> given up; never done
TEST(SkillExecutive, IsNeverDoneWithoutAHandThatIsMeasuredThere) {
  const std::vector<std::function<void(World&)>> catalogue{
      [](World& w) { w.control_silent = true; }, [](World& w) { w.control_fails = true; },
      [](World& w) { w.hand_known = false; },
      [](World& w) { w.arm_follows = false; },  // set-points run on, the controller is dead
  };
  for (const bool tracking : {false, true}) {
    for (const auto& begin : catalogue) {
      World world;
      if (tracking) world.until(ExecutionState::kTracking, 2);
      if (!tracking) world.run(0.3);
      begin(world);
      if (tracking && !world.arm_follows) world.hand.position.x() -= 0.3;
      bool stopped = false;
      for (int i = 0; i < 2500; ++i) {
        const ExecutiveResult result = world.tick();
        ASSERT_NE(result.progress.state, ExecutionState::kDone);
        stopped = stopped || result.progress.state == ExecutionState::kStopped;
      }
      EXPECT_TRUE(stopped);
    }
  }
}

TEST(SkillExecutive, CountsTheHoldTimeOnlyWhileTheHandIsWithinTheGoalTolerance) {
  World world;
  world.until(ExecutionState::kTracking, 2);
  world.arm_follows = false;
  world.hand.position.y() = 0.06;  // beyond goal_tolerance, within following_tolerance
  EXPECT_EQ(world.run(3).progress.state, ExecutionState::kTracking);
  world.hand.position.y() = 0.04;
  EXPECT_EQ(world.run(0.9).progress.state, ExecutionState::kTracking);
  EXPECT_EQ(world.run(0.2).progress.state, ExecutionState::kDone);
}

TEST(SkillExecutive, SaysAtTheTimeLimitThatTheHandWasNotThere) {
  World world;
  world.until(ExecutionState::kTracking, 2);
  world.arm_follows = false;
  world.hand.position.y() = 0.06;
  EXPECT_EQ(world.until(ExecutionState::kStopped, 20).progress.reason,
            "not done within 20.00 s: the hand is 0.06 m and 0.00 rad from its set-point");
}

TEST(SkillExecutive, TellsTheGoalDistanceOfTheMeasuredHand) {
  World world;
  world.until(ExecutionState::kTracking, 2);
  world.run(0.2);
  world.arm_follows = false;
  world.hand.position.y() += 0.04;
  const Progress progress = world.tick().progress;
  EXPECT_NEAR(progress.goal_distance->distance, 0.04, 1e-3);
  EXPECT_NEAR(progress.following->position, 0.04, 1e-3);
}

}  // namespace
}  // namespace prf_decision
