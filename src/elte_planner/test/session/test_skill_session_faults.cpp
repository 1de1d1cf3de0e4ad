// SPDX-License-Identifier: BSD-3-Clause
// Infeasible and late solves, absurd goals, a session begun in mid-execution.
#include <gtest/gtest.h>

#include "elte_planner/skill_session.hpp"
#include "reach_skill.hpp"

namespace elte_planner {
namespace {

// Fault 23: a solve that does not end within its bound of work -> the last plan is sent as KEPT
TEST(SkillSession, KeepsTheLastPlanWhenASolveIsPastItsDeadline) {
  SessionParams hurried = params();
  hurried.approach_length = 0.15;
  hurried.radius_max = 0.05;
  const TargetForecast forecast = drifting();
  const SkillResult unhurried = SkillSession(hurried, reach()).plan(at(10, 1.6), &forecast);
  ASSERT_EQ(unhurried.status, SkillStatus::kSolved) << unhurried.message;
  hurried.max_iterations = 1;
  SkillSession session(hurried, reach());
  const SkillResult none = session.plan(at(10, 1.6), &forecast);
  EXPECT_EQ(none.status, SkillStatus::kNoPlan);
  EXPECT_EQ(none.message, "not solved within 1 changes of the active set");
  EXPECT_TRUE(none.poses.empty());
  const TargetForecast at_rest = resting();
  const SkillResult before = session.plan(at(2, 2.0), &at_rest);
  ASSERT_EQ(before.status, SkillStatus::kSolved) << before.message;
  const SkillResult kept = session.plan(at(10, 1.6), &forecast);
  EXPECT_EQ(kept.status, SkillStatus::kKept);
  EXPECT_EQ(kept.poses.back().pose.position, before.poses.back().pose.position);
}

// Fault 26: planner respawned in mid-execution -> its first plan is near the one executed, not the
TEST(SkillSession, AdaptsFrozenNodesThatItDoesNotKnow) {
  TargetForecast far = drifting();
  for (TargetPrediction& p : far.predictions) p.target.pose.position.x() += 0.2;
  SkillSession executed(params(), reach());
  const SkillResult before = executed.plan(at(2, 1.6), &far);
  SkillSession respawned(params(), reach());
  const SkillResult after = respawned.plan(at(40, 0.5), &far);
  for (std::size_t k = 38; k < 50; ++k) {
    const double moved = (after.poses[k].pose.position - before.poses[k].pose.position).norm();
    EXPECT_LT(moved, 0.15) << k;
    EXPECT_LT(moved,
              (before.poses[k].pose.position - respawned.demonstration().samples()[k].pose.position)
                  .norm())
        << k;
  }
}

// Fault 22: ELTE infeasible (balls of the approach against the bound on steps) -> the last plan is
TEST(SkillSession, KeepsTheLastPlanWhenTheConstraintsContradictEachOther) {
  SessionParams slow = params();
  slow.max_step = 0.02;
  slow.approach_length = 0.1;
  SkillSession session(slow, reach());
  TargetForecast forecast = drifting();
  const SkillResult before = session.plan(at(2, 2.0), &forecast);
  ASSERT_EQ(before.status, SkillStatus::kSolved) << before.message;
  for (TargetPrediction& p : forecast.predictions) p.target.pose.position.x() += 0.5;
  const SkillResult kept = session.plan(at(42, 0.2), &forecast);
  EXPECT_EQ(kept.status, SkillStatus::kKept);
  EXPECT_FALSE(kept.message.empty());
  EXPECT_EQ(kept.poses.back().pose.position, before.poses.back().pose.position);
}

// Fault 43: finite but absurd goals -> the solve is refused and the last plan kept
TEST(SkillSession, KeepsTheLastPlanWhenASolveFails) {
  SkillSession session(params(), reach());
  const TargetForecast forecast = drifting();
  const SkillResult before = session.plan(at(2, 1.0), &forecast);
  TargetForecast absurd = forecast;
  for (TargetPrediction& p : absurd.predictions) p.target.pose.position.setConstant(1e308);
  const SkillResult kept = session.plan(at(10, 0.8), &absurd);
  ASSERT_EQ(kept.status, SkillStatus::kKept);
  EXPECT_FALSE(kept.message.empty());
  EXPECT_EQ(kept.poses.back().pose.position, before.poses.back().pose.position);
}

// Fault 22: target beyond what the bound on steps allows -> RELAXED, the slack is reported
TEST(SkillSession, OpensTheRadiusWhenTheTargetIsBeyondReach) {
  SessionParams slow = params();
  slow.max_step = 0.02;
  SkillSession session(slow, reach());
  TargetForecast forecast = drifting();
  ASSERT_EQ(session.plan(at(2, 1.0), &forecast).status, SkillStatus::kSolved);
  for (TargetPrediction& p : forecast.predictions) p.target.pose.position.x() += 0.5;
  const SkillResult result = session.plan(at(40, 0.2), &forecast);
  ASSERT_EQ(result.status, SkillStatus::kRelaxed) << result.message;
  EXPECT_FALSE(result.message.empty());
  EXPECT_GT(result.slack, 0.1);
  for (std::size_t k = 40; k < 50; ++k) {
    EXPECT_LE((result.poses[k].pose.position - result.poses[k - 1].pose.position).lpNorm<1>(),
              0.02 + 1e-12);
  }
}

}  // namespace
}  // namespace elte_planner
