// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/skill_executive.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "executive_world.hpp"

namespace prf_decision {
namespace {

TEST(SkillExecutive, WaitsWithoutATargetAndSaysSo) {
  World world;
  world.status = TargetStatus::kNoTarget;
  const ExecutiveResult result = world.run(1);
  EXPECT_EQ(result.progress.state, ExecutionState::kWaiting);
  EXPECT_EQ(result.progress.reason, "target not seen yet");
  EXPECT_FALSE(result.setpoint);
}

TEST(SkillExecutive, WaitsWithoutAPlanAndSaysWhatThePlannerSaid) {
  World world;
  world.plan = nullptr;
  const ExecutiveResult result = world.run(0.1);
  EXPECT_EQ(result.progress.state, ExecutionState::kWaiting);
  EXPECT_EQ(result.progress.reason, "no plan yet: no solution");
  EXPECT_EQ(result.progress.frozen, 0u);
  EXPECT_FALSE(result.setpoint);
}

TEST(SkillExecutive, ExecutesTheSkillThenFollowsTheTargetAndIsDoneAfterTheHoldTime) {
  World world;
  const ExecutiveResult start = world.until(ExecutionState::kForward, 0.1);
  EXPECT_NEAR(start.progress.cursor, 0.1, 1e-9);
  const ExecutiveResult arrived = world.until(ExecutionState::kTracking, 1.1);
  EXPECT_EQ(arrived.progress.cursor, 10);
  EXPECT_EQ(arrived.progress.frozen, 11u);
  EXPECT_EQ(arrived.progress.time_to_go, Duration{0});
  const ExecutiveResult done = world.until(ExecutionState::kDone, 1.1);
  EXPECT_EQ(done.progress.reason, "tracked for 1.00 s");
  ASSERT_TRUE(done.setpoint);
  EXPECT_LT((done.setpoint->pose.position - Eigen::Vector3d(0.6, 0, 0.5)).norm(), 1e-9);
}

TEST(SkillExecutive, NamesTheForecastInForce) {
  World world;
  EXPECT_EQ(world.tick().progress.forecast_stamp, from_seconds(49.94));
  world.tick();
  world.tick();
  EXPECT_EQ(world.tick().progress.forecast_stamp, from_seconds(49.97));
}

TEST(SkillExecutive, FollowsTheForecastAheadByTheLead) {
  World world;
  world.until(ExecutionState::kTracking, 2);
  world.velocity = {0, 0.1, 0};
  for (int tick = 0; tick < 200; ++tick) {
    const double y = world.position.y();
    const ExecutiveResult result = world.tick();
    world.position.y() += world.velocity.y() * to_seconds(kTickPeriod);
    if (tick < 150) continue;  // the step in velocity is still being caught up with
    // The image is 0.06 s old and the lead 0.02 s.
    EXPECT_NEAR(result.setpoint->pose.position.y(), y + 0.1 * 0.08, 1e-7);
    EXPECT_NEAR(result.setpoint->linear_velocity.y(), 0.1, 1e-6);
  }
}

TEST(SkillExecutive, PausesAndGoesBackAsTheTargetQuickens) {
  World world;
  world.until(ExecutionState::kForward, 0.1);
  world.run(0.5);
  world.velocity = {0, 0.3, 0};
  const ExecutiveResult pause = world.until(ExecutionState::kPause, 2);
  EXPECT_EQ(pause.progress.reason.rfind("belief in pause ", 0), 0u) << pause.progress.reason;
  const ExecutiveResult later = world.run(0.3);
  EXPECT_EQ(later.progress.cursor, pause.progress.cursor);
  EXPECT_EQ(later.setpoint->linear_velocity.norm(), 0);
  world.velocity = {0, 0.7, 0};
  const ExecutiveResult back = world.until(ExecutionState::kReverse, 1);
  const ExecutiveResult rewound = world.run(2);
  EXPECT_LT(rewound.progress.cursor, back.progress.cursor);
  EXPECT_EQ(rewound.progress.cursor, 0);
  EXPECT_EQ(rewound.progress.frozen, 2u);
  EXPECT_LT(rewound.setpoint->linear_velocity.norm(), 1e-6);
  world.velocity = kStill;
  world.until(ExecutionState::kForward, 2);
}

TEST(SkillExecutive, StaysWithTheTargetWhilePausedOnTheApproach) {
  DecisionParams parameters = usual_params();
  parameters.reference.approach_length = 0.1;
  World world(parameters);
  world.until(ExecutionState::kForward, 0.1);
  world.run(0.75);
  world.velocity = {0, 0.3, 0};
  const auto tick = [&world] {
    world.position += world.velocity * to_seconds(kTickPeriod);
    return world.tick();
  };
  double cursor = 0;
  for (int i = 0; i < 20; ++i) cursor = tick().progress.cursor;
  for (int i = 0; i < 100; ++i) {
    const double y = world.position.y();
    const ExecutiveResult result = tick();
    ASSERT_EQ(result.progress.state, ExecutionState::kPause);
    EXPECT_EQ(result.progress.cursor, cursor);
    EXPECT_NEAR(result.setpoint->pose.position.y(), y, 0.05);
  }
}

TEST(SkillExecutive, RetractsFromTrackingWhenTheTargetBecomesUnstable) {
  World world;
  world.until(ExecutionState::kTracking, 2);
  world.velocity = {0, 0.7, 0};
  world.until(ExecutionState::kRetract, 1);
  EXPECT_LT(world.run(0.5).progress.cursor, 6);
  world.velocity = kStill;
  world.until(ExecutionState::kDone, 5);
}

// Fault 31: HMM chatters at a threshold -> at most one change per dwell time
TEST(SkillExecutive, ChangesAtMostOncePerDwellTimeWhenTheHmmChatters) {
  DecisionParams parameters = usual_params();
  // A memory of no observation: the belief follows every single velocity.
  parameters.hmm.transition.setConstant(1.0 / 3);
  World world(parameters);
  world.until(ExecutionState::kForward, 0.1);
  ExecutionState state = ExecutionState::kForward;
  int since = 0;
  int changes = 0;
  for (int i = 0; i < 600; ++i, ++since) {
    world.velocity = {0, i % 6 < 3 ? 0.0 : 0.3, 0};
    const ExecutionState now = world.tick().progress.state;
    if (now != state && now != ExecutionState::kTracking && now != ExecutionState::kDone) {
      EXPECT_GE(since, 20 - 1) << "tick " << i;
      since = 0;
      ++changes;
    }
    state = now;
  }
  EXPECT_GE(changes, 4);
}

TEST(SkillExecutive, StopsAtTheTimeLimit) {
  DecisionParams parameters = usual_params();
  parameters.time_limit = from_seconds(1.5);
  World world(parameters);
  const ExecutiveResult result = world.until(ExecutionState::kStopped, 1.6);
  EXPECT_EQ(result.progress.reason, "not done within 1.50 s");
}

TEST(SkillExecutive, RestartsTheHoldTimeWhenTheGoalRunsAway) {
  World world;
  world.until(ExecutionState::kTracking, 2);
  world.run(0.8);
  world.position.y() = 0.2;  // 1 s away at 0.2 m/s
  EXPECT_EQ(world.run(1.5).progress.state, ExecutionState::kTracking);
  world.until(ExecutionState::kDone, 0.6);
}

// Fault 23: a plan that comes late or is another one -> taken without a jump of the set-point
TEST(SkillExecutive, TakesANewPlanWithoutAJumpEvenWhenItsFrozenPartChanged) {
  World world;
  world.until(ExecutionState::kForward, 0.1);
  world.run(0.4);
  Trajectory moved = straight_skill();
  for (Pose& pose : moved.poses) pose.position.y() += 0.05;
  world.plan = std::make_shared<Trajectory>(moved);
  world.until(ExecutionState::kDone, 4);  // World checks every step
}

TEST(SkillExecutive, KeepsItsCursorWithinAShorterPlan) {
  World world;
  world.until(ExecutionState::kTracking, 2);
  Trajectory shorter = straight_skill();
  shorter.poses.resize(5);
  shorter.times.resize(5);
  world.plan = std::make_shared<Trajectory>(shorter);
  EXPECT_EQ(world.run(0.1).progress.cursor, 4);
}

TEST(SkillExecutive, BlindGoesToTheEndAndHoldsWhateverTheTargetDoes) {
  DecisionParams parameters = usual_params();
  parameters.reference.adaptation = Adaptation::kOnce;
  World world(parameters);
  world.until(ExecutionState::kForward, 0.1);
  world.velocity = {0, 0.9, 0};
  world.position = {5, 0, 0};
  world.status = TargetStatus::kLost;
  world.planner_silent = true;
  const ExecutiveResult arrived = world.until(ExecutionState::kTracking, 1.1);
  EXPECT_EQ(arrived.progress.posterior, Eigen::Vector3d::UnitX());
  const ExecutiveResult done = world.until(ExecutionState::kDone, 1.1);
  EXPECT_LT((done.setpoint->pose.position - Eigen::Vector3d(0.6, 0, 0.5)).norm(), 1e-12);
  EXPECT_LT(done.setpoint->linear_velocity.norm(), 1e-9);
}

TEST(SkillExecutive, ResumesFromAMissedForecastWithoutNamingIt) {
  SkillExecutive executive(usual_params());
  Tick tick;
  tick.stamp = from_seconds(1);
  tick.forecasts.push_back({from_seconds(0.94), nullptr});
  EXPECT_EQ(executive.update(tick).progress.forecast_stamp, Stamp{0});
}

// Fault 28: parameters garbage, infinite or absurd -> refused by name, value and bound
TEST(DecisionParams, AreRefusedByName) {
  const std::vector<std::pair<std::string, std::function<void(DecisionParams&)>>> catalogue{
      {"hold_time", [](auto& p) { p.hold_time = from_seconds(1e5); }},
      {"dwell_time", [](auto& p) { p.dwell_time = from_seconds(6); }},
      {"time_limit", [](auto& p) { p.time_limit = from_seconds(1e5); }},
      {"lead", [](auto& p) { p.reference.lead = from_seconds(2); }},
      {"catch_up_speed angular", [](auto& p) { p.reference.catch_up.angular = 1e308; }},
      {"catch_up_time", [](auto& p) { p.reference.catch_up.time_constant = 5e-324; }},
      {"max_wait", [](auto& p) { p.guards.max_gap = Duration{0}; }},
      {"lead", [](auto& p) { p.reference.lead = Duration{-1}; }},
      {"hold_time", [](auto& p) { p.hold_time = Duration{-1}; }},
      {"dwell_time", [](auto& p) { p.dwell_time = Duration{-1}; }},
      {"time_limit", [](auto& p) { p.time_limit = Duration{0}; }},
      {"tracking_tolerance", [](auto& p) { p.reference.tracking_tolerance = NAN; }},
      {"approach_length", [](auto& p) { p.reference.approach_length = -1; }},
      {"catch_up_speed", [](auto& p) { p.reference.catch_up.linear = 0; }},
      {"catch_up_time", [](auto& p) { p.reference.catch_up.time_constant = 0; }},
      {"max_reach", [](auto& p) { p.guards.max_reach = -1; }},
      {"initial", [](auto& p) { p.hmm.initial.setZero(); }},
  };
  for (const auto& [culprit, spoil] : catalogue) {
    DecisionParams parameters = usual_params();
    spoil(parameters);
    try {
      SkillExecutive executive(parameters);
      ADD_FAILURE() << "accepted: " << culprit;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind(culprit, 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace prf_decision
