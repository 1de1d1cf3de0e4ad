// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/decision.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "decision_world.hpp"

namespace prf_decision {
namespace {

TEST(Decision, WaitsWithoutATargetAndSaysSo) {
  World world;
  world.status = TargetStatus::kNoTarget;
  const Outcome outcome = world.run(1);
  EXPECT_EQ(outcome.progress.state, State::kWaiting);
  EXPECT_EQ(outcome.progress.reason, "target not seen yet");
  EXPECT_FALSE(outcome.setpoint);
}

TEST(Decision, WaitsWithoutAPlanAndSaysWhatThePlannerSaid) {
  World world;
  world.plan = nullptr;
  const Outcome outcome = world.run(0.1);
  EXPECT_EQ(outcome.progress.state, State::kWaiting);
  EXPECT_EQ(outcome.progress.reason, "no plan yet: no solution");
  EXPECT_EQ(outcome.progress.frozen, 0u);
  EXPECT_FALSE(outcome.setpoint);
}

TEST(Decision, ExecutesTheSkillThenFollowsTheTargetAndIsDoneAfterTheHoldTime) {
  World world;
  const Outcome start = world.until(State::kForward, 0.1);
  EXPECT_NEAR(start.progress.cursor, 0.1, 1e-9);
  const Outcome arrived = world.until(State::kTracking, 1.1);
  EXPECT_EQ(arrived.progress.cursor, 10);
  EXPECT_EQ(arrived.progress.frozen, 11u);
  EXPECT_EQ(arrived.progress.time_to_go, Duration{0});
  const Outcome done = world.until(State::kDone, 1.1);
  EXPECT_EQ(done.progress.reason, "tracked for 1.00 s");
  ASSERT_TRUE(done.setpoint);
  EXPECT_LT((done.setpoint->pose.position - Eigen::Vector3d(0.6, 0, 0.5)).norm(), 1e-9);
}

TEST(Decision, NamesTheForecastInForce) {
  World world;
  EXPECT_EQ(world.tick().progress.forecast_stamp, from_seconds(49.94));
  world.tick();
  world.tick();
  EXPECT_EQ(world.tick().progress.forecast_stamp, from_seconds(49.97));
}

TEST(Decision, FollowsTheForecastAheadByTheLead) {
  World world;
  world.until(State::kTracking, 2);
  world.velocity = {0, 0.1, 0};
  for (int tick = 0; tick < 200; ++tick) {
    const double y = world.position.y();
    const Outcome outcome = world.tick();
    world.position.y() += world.velocity.y() * to_seconds(kTickPeriod);
    if (tick < 150) continue;  // the step in velocity is still being caught up with
    // The image is 0.06 s old and the lead 0.02 s.
    EXPECT_NEAR(outcome.setpoint->pose.position.y(), y + 0.1 * 0.08, 1e-7);
    EXPECT_NEAR(outcome.setpoint->linear_velocity.y(), 0.1, 1e-6);
  }
}

TEST(Decision, PausesAndGoesBackAsTheTargetQuickens) {
  World world;
  world.until(State::kForward, 0.1);
  world.run(0.5);
  world.velocity = {0, 0.3, 0};
  const Outcome pause = world.until(State::kPause, 2);
  EXPECT_EQ(pause.progress.reason.rfind("belief in pause ", 0), 0u) << pause.progress.reason;
  const Outcome later = world.run(0.3);
  EXPECT_EQ(later.progress.cursor, pause.progress.cursor);
  EXPECT_EQ(later.setpoint->linear_velocity.norm(), 0);
  world.velocity = {0, 0.7, 0};
  const Outcome back = world.until(State::kReverse, 1);
  const Outcome rewound = world.run(2);
  EXPECT_LT(rewound.progress.cursor, back.progress.cursor);
  EXPECT_EQ(rewound.progress.cursor, 0);
  EXPECT_EQ(rewound.progress.frozen, 2u);
  EXPECT_LT(rewound.setpoint->linear_velocity.norm(), 1e-6);
  world.velocity = kStill;
  world.until(State::kForward, 2);
}

TEST(Decision, StaysWithTheTargetWhilePausedOnTheApproach) {
  DecisionParams parameters = usual_params();
  parameters.approach_length = 0.1;
  World world(parameters);
  world.until(State::kForward, 0.1);
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
    const Outcome outcome = tick();
    ASSERT_EQ(outcome.progress.state, State::kPause);
    EXPECT_EQ(outcome.progress.cursor, cursor);
    EXPECT_NEAR(outcome.setpoint->pose.position.y(), y, 0.05);
  }
}

TEST(Approach, IsThePlanWhileTheTargetMovesAsForecastAndTheTargetsWhereItDoesNot) {
  const Trajectory plan = straight_skill();
  const Stamp start = from_seconds(5);
  const TargetForecast forecast = forecast_of(start, kTarget, {0.1, 0.2, 0});
  Approach approach;
  EXPECT_EQ(approach.share(10, 0.1), 0);
  approach.take(plan, 6, start, forecast);
  for (const double cursor : {6.0, 7.0, 9.0, 10.0}) {
    MovingPose target = predicted_target(forecast, start + from_seconds(0.1 * (cursor - 6))).target;
    const Eigen::Vector3d planned = hand_at(plan, cursor, Direction::kForward).pose.position;
    const auto position = [&] {
      return approach.hand(cursor, Direction::kForward, target, 0.3).pose.position;
    };
    EXPECT_LT((position() - planned).norm(), 1e-12) << cursor;
    target.pose.position.y() += 0.05;
    EXPECT_LT((position() - planned - Eigen::Vector3d(0, 0.05, 0)).norm(), 1e-12) << cursor;
  }
  approach.take(plan, 6, start, forecast_of(start, kTarget, kStill));
  EXPECT_LT((approach.hand(10, Direction::kStand, predicted_target(forecast, start).target, 0.3)
                 .pose.position -
             plan.poses[10].position + 0.4 * Eigen::Vector3d(0.1, 0.2, 0))
                .norm(),
            1e-12)
      << "a node that a new plan leaves where it is keeps its anchor";
}

TEST(Decision, RetractsFromTrackingWhenTheTargetBecomesUnstable) {
  World world;
  world.until(State::kTracking, 2);
  world.velocity = {0, 0.7, 0};
  world.until(State::kRetract, 1);
  EXPECT_LT(world.run(0.5).progress.cursor, 6);
  world.velocity = kStill;
  world.until(State::kDone, 5);
}

TEST(Decision, ChangesAtMostOncePerDwellTimeWhenTheHmmChatters) {
  DecisionParams parameters = usual_params();
  // A memory of no observation: the belief follows every single velocity.
  parameters.hmm.transition.setConstant(1.0 / 3);
  World world(parameters);
  world.until(State::kForward, 0.1);
  State state = State::kForward;
  int since = 0;
  int changes = 0;
  for (int i = 0; i < 600; ++i, ++since) {
    world.velocity = {0, i % 6 < 3 ? 0.0 : 0.3, 0};
    const State now = world.tick().progress.state;
    if (now != state && now != State::kTracking && now != State::kDone) {
      EXPECT_GE(since, 20 - 1) << "tick " << i;
      since = 0;
      ++changes;
    }
    state = now;
  }
  EXPECT_GE(changes, 4);
}

// Every guard acts in forward while the HMM says Forward, and lets go afterwards.
TEST(Decision, PausesForEveryHazardWhateverTheHmmSaysAndGoesOnAfterIt) {
  struct Hazard {
    std::function<void(World&)> begin;
    std::string reason;
  };
  const std::vector<Hazard> catalogue{
      {[](World& w) { w.forecast_stale = true; }, "forecast silent for "},
      {[](World& w) { w.plan_stale = true; }, "planner silent"},
      {[](World& w) { w.plan = nullptr; }, "planner has no plan: no solution"},
      {[](World& w) { w.status = TargetStatus::kNoTarget; }, "predictor has lost the target"},
      {[](World& w) { w.status = TargetStatus::kLost; }, "predictor has lost the target"},
      {[](World& w) { w.status = TargetStatus::kCoasting; }, "target unseen for "},
      {[](World& w) {
         w.position = {2.5, 0, 0.5};
       },
       "forecast 2.51 m from the shoulder"},
      {[](World& w) {
         w.position = {1.6, 0, 0.5};
       },
       "goal 1.22 m from the shoulder"},
      {[](World& w) { w.leap(0.31); }, "joint_states silent for 0.32 s"},
  };
  for (const auto& [begin, reason] : catalogue) {
    World world;
    world.until(State::kForward, 0.1);
    world.run(0.3);
    const auto plan = world.plan;
    begin(world);
    const Outcome paused = world.until(State::kPause, 0.4);
    EXPECT_EQ(paused.progress.reason.rfind(reason, 0), 0u)
        << paused.progress.reason << " for " << reason;
    EXPECT_GT(paused.progress.posterior[0], 0.5);
    world.forecast_stale = world.plan_stale = false;
    world.status = TargetStatus::kTracking;
    world.position = kTarget;
    world.plan = plan;
    world.until(State::kDone, 4);
  }
}

TEST(Decision, HoldsWhereItIsWhenAHazardEndsTheTracking) {
  World world;
  world.until(State::kTracking, 2);
  const Outcome before = world.run(0.1);
  world.position = {2.5, 0, 0.5};
  world.until(State::kPause, 0.1);
  const Outcome after = world.run(1);
  EXPECT_EQ(after.setpoint->pose.position, before.setpoint->pose.position);
}

TEST(Decision, KeepsTrackingTheLastBeliefNoLongerThanTheFirstLimitOnceDone) {
  World world;
  const Outcome done = world.until(State::kDone, 5);
  world.status = TargetStatus::kCoasting;
  world.velocity = {0, 0.2, 0};
  world.run(0.5);
  const Outcome held = world.run(1);
  EXPECT_EQ(held.progress.state, State::kDone);
  EXPECT_EQ(held.setpoint->linear_velocity.norm(), 0);
  EXPECT_EQ(held.progress.reason, done.progress.reason);
}

TEST(Decision, PausesThenGoesBackThenStopsWhenTheTargetStaysLost) {
  World world;
  world.until(State::kForward, 0.1);
  world.run(0.5);
  world.status = TargetStatus::kCoasting;
  world.until(State::kPause, 0.4);
  const Outcome back = world.until(State::kReverse, 0.8);
  EXPECT_EQ(back.progress.reason.rfind("target unseen for 1.0", 0), 0u) << back.progress.reason;
  const Outcome stopped = world.until(State::kStopped, 1.1);
  EXPECT_EQ(stopped.progress.reason.rfind("target unseen for 2.0", 0), 0u);
  EXPECT_FALSE(stopped.setpoint);
  world.status = TargetStatus::kTracking;
  EXPECT_EQ(world.run(1).progress.state, State::kStopped);
}

TEST(Decision, StopsAtTheTimeLimit) {
  DecisionParams parameters = usual_params();
  parameters.time_limit = from_seconds(1.5);
  World world(parameters);
  const Outcome outcome = world.until(State::kStopped, 1.6);
  EXPECT_EQ(outcome.progress.reason, "not done within 1.50 s");
}

TEST(Decision, RestartsTheHoldTimeWhenTheGoalRunsAway) {
  World world;
  world.until(State::kTracking, 2);
  world.run(0.8);
  world.position.y() = 0.2;  // 1 s away at 0.2 m/s
  EXPECT_EQ(world.run(1.5).progress.state, State::kTracking);
  world.until(State::kDone, 0.6);
}

TEST(Decision, TakesANewPlanWithoutAJumpEvenWhenItsFrozenPartChanged) {
  World world;
  world.until(State::kForward, 0.1);
  world.run(0.4);
  Trajectory moved = straight_skill();
  for (Pose& pose : moved.poses) pose.position.y() += 0.05;
  world.plan = std::make_shared<Trajectory>(moved);
  world.until(State::kDone, 4);  // World checks every step
}

TEST(Decision, KeepsItsCursorWithinAShorterPlan) {
  World world;
  world.until(State::kTracking, 2);
  Trajectory shorter = straight_skill();
  shorter.poses.resize(5);
  shorter.times.resize(5);
  world.plan = std::make_shared<Trajectory>(shorter);
  EXPECT_EQ(world.run(0.1).progress.cursor, 4);
}

TEST(Decision, BlindGoesToTheEndAndHoldsWhateverTheTargetDoes) {
  DecisionParams parameters = usual_params();
  parameters.framework = false;
  World world(parameters);
  world.until(State::kForward, 0.1);
  world.velocity = {0, 0.9, 0};
  world.position = {5, 0, 0};
  world.status = TargetStatus::kLost;
  world.plan_stale = true;
  const Outcome arrived = world.until(State::kTracking, 1.1);
  EXPECT_EQ(arrived.progress.posterior, Eigen::Vector3d::UnitX());
  const Outcome done = world.until(State::kDone, 1.1);
  EXPECT_LT((done.setpoint->pose.position - Eigen::Vector3d(0.6, 0, 0.5)).norm(), 1e-12);
  EXPECT_LT(done.setpoint->linear_velocity.norm(), 1e-9);
}

TEST(Decision, ResumesFromAMissedForecastWithoutNamingIt) {
  Decision decision(usual_params());
  Tick tick;
  tick.stamp = from_seconds(1);
  tick.forecasts.push_back({from_seconds(0.94), nullptr});
  EXPECT_EQ(decision.update(tick).progress.forecast_stamp, Stamp{0});
}

TEST(DecisionParams, AreRefusedByName) {
  const std::vector<std::pair<std::string, std::function<void(DecisionParams&)>>> catalogue{
      {"max_wait", [](auto& p) { p.max_gap = Duration{0}; }},
      {"lead", [](auto& p) { p.lead = Duration{-1}; }},
      {"hold_time", [](auto& p) { p.hold_time = Duration{-1}; }},
      {"dwell_time", [](auto& p) { p.dwell_time = Duration{-1}; }},
      {"time_limit", [](auto& p) { p.time_limit = Duration{0}; }},
      {"tracking_tolerance", [](auto& p) { p.tracking_tolerance = NAN; }},
      {"approach_length", [](auto& p) { p.approach_length = -1; }},
      {"catch_up_speed", [](auto& p) { p.catch_up.linear = 0; }},
      {"catch_up_time", [](auto& p) { p.catch_up.time_constant = 0; }},
      {"max_reach", [](auto& p) { p.guards.max_reach = -1; }},
      {"initial", [](auto& p) { p.hmm.initial.setZero(); }},
  };
  for (const auto& [culprit, spoil] : catalogue) {
    DecisionParams parameters = usual_params();
    spoil(parameters);
    try {
      Decision decision(parameters);
      ADD_FAILURE() << "accepted: " << culprit;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind(culprit, 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace prf_decision
