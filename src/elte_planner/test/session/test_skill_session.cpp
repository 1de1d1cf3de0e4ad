// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/skill_session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "elte_planner/confidence_radius.hpp"

namespace elte_planner {
namespace {

using prf_core::pose_from;

using prf_core::from_seconds;
using prf_core::TargetForecast;
using prf_core::TargetPrediction;
using prf_core::TargetStatus;

constexpr prf_core::Stamp kStamp = std::chrono::seconds(10);  // of every forecast

Demonstration reach() {
  std::vector<TimedPose> samples;
  for (int i = 0; i <= 200; ++i) {
    const double s = i / 200.0;
    samples.push_back({0.04 * i,
                       {{0.3 + 0.3 * s, 0.1 * std::sin(M_PI * s), 0.2 + 0.2 * s * s},
                        Eigen::Quaterniond(Eigen::AngleAxisd(0.6 * s, Eigen::Vector3d::UnitY()))}});
  }
  const Pose target{{1.0, 0.0, 0.5},
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()))};
  return Demonstration(samples, "arm", "hand", target);
}

SessionParams params() {
  SessionParams result;
  result.planner = "elte";
  result.nodes = 50;
  result.horizon_max = 2.0;
  result.confidence = 0.5;
  result.radius_min = 0.001;
  result.radius_max = 0.02;
  return result;
}

TargetPrediction prediction(double horizon, const Eigen::Vector3d& offset, double deviation) {
  Pose target = reach().target();
  target.position += offset;
  TargetPrediction result;
  result.horizon = from_seconds(horizon);
  result.target.pose = target;
  result.covariance.topLeftCorner<3, 3>().diagonal().setConstant(deviation * deviation);
  return result;
}

// Drifts by 0.1 m/s along y, deviation growing from 1 mm by 10 mm/s.
TargetForecast drifting(TargetStatus status = TargetStatus::kTracking) {
  TargetForecast forecast{kStamp, status, prf_core::Duration{0}, {}};
  for (const double horizon : {0.0, 0.5, 1.0, 2.0, 4.0}) {
    forecast.predictions.push_back(
        prediction(horizon, {0.0, 0.1 * horizon, 0.02}, 0.001 + 0.01 * horizon));
    forecast.predictions.back().target.linear_velocity.y() = 0.1;
  }
  return forecast;
}

// At its demonstrated place for good.
TargetForecast resting() {
  return {kStamp,
          TargetStatus::kTracking,
          prf_core::Duration{0},
          {prediction(0.0, {0.0, 0.0, 0.0}, 0.1)}};
}

Progress at(Eigen::Index frozen, double time_to_go) {
  return {kStamp + std::chrono::milliseconds(100), kStamp, frozen, from_seconds(time_to_go)};
}

double end_distance(const SkillResult& result, const Pose& goal) {
  return (result.poses.back().pose.position - goal.position).lpNorm<1>();
}

TEST(SkillSession, EndsAtTheDemonstratedPoseRelativeToThePredictedTarget) {
  SkillSession session(params(), reach());
  const TargetForecast forecast = drifting();
  const SkillResult result = session.plan(at(2, 0.65), &forecast);
  ASSERT_EQ(result.status, SkillStatus::kSolved) << result.message;
  ASSERT_EQ(result.poses.size(), 50u);
  // 0.65 s to go and a forecast 0.1 s old: the target in 0.75 s.
  const Pose target = prediction(0.75, {0.0, 0.075, 0.02}, 0.0).target.pose;
  const Pose goal = pose_from(target.isometry() * reach().goal_in_target().isometry());
  EXPECT_LE(end_distance(result, goal), result.radius + 1e-12);
  EXPECT_LT(result.poses.back().pose.orientation.angularDistance(goal.orientation), 1e-7);
  EXPECT_LE(result.kkt_residual, 1e-14);
  EXPECT_EQ(result.poses[1].time, reach().resampled_by_arc_length(50).samples()[1].time);
}

TEST(SkillSession, BringsTheApproachWithTheTargetAsItIsAtTheTimeOfEachNode) {
  SessionParams bound = params();
  bound.approach_length = 0.15;
  SkillSession session(bound, reach());
  const TargetForecast forecast = drifting();
  const SkillResult result = session.plan(at(10, 1.6), &forecast);
  ASSERT_EQ(result.status, SkillStatus::kSolved) << result.message;
  EXPECT_LE(result.kkt_residual, 1e-12);
  const auto& shown = session.demonstration().samples();
  int checked = 0;
  for (std::size_t k = 48; k >= 10; --k, ++checked) {
    const double distance = (shown[k].pose.position - shown[49].pose.position).norm();
    if (distance > bound.approach_length) break;
    const double time = std::max(1.7 - (shown[49].time - shown[k].time), 0.0);
    const Pose moved = prediction(time, {0.0, 0.1 * time, 0.02}, 0.0).target.pose;
    const Pose expected = pose_from(moved.isometry() * reach().target().isometry().inverse() *
                                    shown[k].pose.isometry());
    const double radius = result.radius + 0.1 * distance;
    EXPECT_LE((result.poses[k].pose.position - expected.position).lpNorm<1>(), radius + 1e-12) << k;
    EXPECT_LT(result.poses[k].pose.orientation.angularDistance(expected.orientation), 1e-7) << k;
  }
  EXPECT_GE(checked, 15);
}

TEST(SkillSession, LooksNoFartherAheadThanAllowed) {
  SkillSession near(params(), reach());
  SkillSession far(params(), reach());
  const TargetForecast forecast = drifting();
  EXPECT_EQ(near.plan(at(2, 1.9), &forecast).poses.back().pose.position,
            far.plan(at(2, 50.0), &forecast).poses.back().pose.position);
}

TEST(SkillSession, OpensTheBallWithTheUncertaintyBetweenItsBounds) {
  SessionParams wide = params();
  wide.radius_min = 0.0;
  wide.radius_max = 1.0;
  SkillSession session(wide, reach());
  const TargetForecast forecast = drifting();
  const double radius = session.plan(at(2, 0.9), &forecast).radius;
  EXPECT_NEAR(radius, confidence_radius(0.011 * 0.011 * Eigen::Matrix3d::Identity(), 0.5), 1e-5);
  SkillSession bounded(params(), reach());
  EXPECT_EQ(bounded.plan(at(2, 1.9), &forecast).radius, 0.02);
  SessionParams loose = params();
  loose.radius_min = 0.02;
  EXPECT_EQ(SkillSession(loose, reach()).plan(at(2, 0.0), &forecast).radius, 0.02);
}

TEST(SkillSession, KeepsFrozenNodesOfThePreviousPlan) {
  SkillSession session(params(), reach());
  const TargetForecast forecast = drifting();
  const SkillResult first = session.plan(at(2, 1.0), &forecast);
  const SkillResult second = session.plan(at(20, 0.2), &forecast);
  EXPECT_EQ(second.frozen, 20);
  for (std::size_t k = 0; k < 20; ++k) {
    EXPECT_EQ(second.poses[k].pose.position, first.poses[k].pose.position);
    EXPECT_EQ(second.poses[k].pose.orientation.coeffs(), first.poses[k].pose.orientation.coeffs());
  }
  EXPECT_NE(second.poses[30].pose.position, first.poses[30].pose.position);
}

TEST(SkillSession, HasNoPlanUntilThereIsATarget) {
  SkillSession session(params(), reach());
  const TargetForecast nothing{kStamp, TargetStatus::kNoTarget, prf_core::Duration{0}, {}};
  const TargetForecast lost = drifting(TargetStatus::kLost);
  for (const TargetForecast* forecast :
       {&nothing, &lost, static_cast<const TargetForecast*>(nullptr)}) {
    const SkillResult result = session.plan(at(2, 1.0), forecast);
    EXPECT_EQ(result.status, SkillStatus::kNoPlan);
    EXPECT_TRUE(result.poses.empty());
    EXPECT_FALSE(result.message.empty());
  }
}

TEST(SkillSession, KeepsTheLastPlanWhenTheForecastIsOfNoUse) {
  SkillSession session(params(), reach());
  const TargetForecast good = drifting();
  const SkillResult first = session.plan(at(2, 1.0), &good);

  std::vector<TargetForecast> useless(8, good);
  useless[0].status = TargetStatus::kLost;
  useless[1].predictions.clear();
  useless[2].predictions[1].target.pose.position.x() = std::nan("");
  useless[3].predictions[1].target.pose.orientation.coeffs().setZero();
  useless[4].predictions[0].covariance.setIdentity();
  useless[4].predictions[0].covariance *= -1.0;
  useless[4].predictions.resize(1);
  useless[5].predictions[2].horizon = from_seconds(0.5);
  useless[6].predictions[0].horizon = from_seconds(0.1);
  useless[7].since_measurement = from_seconds(-0.1);
  for (const TargetForecast& forecast : useless) {
    const SkillResult result = session.plan(at(10, 0.6), &forecast);
    EXPECT_EQ(result.status, SkillStatus::kKept);
    EXPECT_FALSE(result.message.empty());
    ASSERT_EQ(result.poses.size(), first.poses.size());
    for (std::size_t k = 0; k < first.poses.size(); ++k) {
      EXPECT_EQ(result.poses[k].pose.position, first.poses[k].pose.position);
    }
  }
  EXPECT_EQ(session.plan(at(10, 0.6), nullptr).status, SkillStatus::kKept);
}

TEST(SkillSession, PlansOnWhileTheForecastCoasts) {
  SkillSession session(params(), reach());
  const TargetForecast coasting = drifting(TargetStatus::kCoasting);
  EXPECT_EQ(session.plan(at(2, 1.0), &coasting).status, SkillStatus::kSolved);
}

TEST(SkillSession, SaysTheSlackWhenAllNodesAreFrozen) {
  SkillSession session(params(), reach());
  const TargetForecast forecast = drifting();
  (void)session.plan(at(2, 2.0), &forecast);
  const SkillResult result = session.plan(at(1000, 0.0), &forecast);
  EXPECT_EQ(result.status, SkillStatus::kRelaxed);
  EXPECT_EQ(result.frozen, 50);
  EXPECT_GT(result.slack, 0.1);
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
// demonstration
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
// kept
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

TEST(SkillSession, AdaptsOnceToTheFirstTrackedTarget) {
  SessionParams blind = params();
  blind.adaptation = Adaptation::kOnce;
  SkillSession session(blind, reach());
  const TargetForecast coasting = drifting(TargetStatus::kCoasting);
  EXPECT_EQ(session.plan(at(2, 1.0), &coasting).status, SkillStatus::kNoPlan);
  const TargetForecast first = drifting();
  const SkillResult adapted = session.plan(at(2, 1.0), &first);
  ASSERT_EQ(adapted.status, SkillStatus::kSolved);
  const Pose goal =
      pose_from(first.predictions[0].target.pose.isometry() * reach().goal_in_target().isometry());
  EXPECT_LE(end_distance(adapted, goal), adapted.radius + 1e-12);

  TargetForecast moved = first;
  for (TargetPrediction& p : moved.predictions) p.target.pose.position.x() += 0.2;
  const TargetForecast lost = drifting(TargetStatus::kLost);
  for (const TargetForecast* later : {static_cast<const TargetForecast*>(&moved), &lost}) {
    const SkillResult repeated = session.plan(at(30, 0.3), later);
    EXPECT_EQ(repeated.status, SkillStatus::kSolved);
    for (std::size_t k = 0; k < 50; ++k) {
      EXPECT_EQ(repeated.poses[k].pose.position, adapted.poses[k].pose.position);
    }
  }
}

TEST(SkillSession, WarnsWhenTheWeightsCostTheShape) {
  EXPECT_EQ(SkillSession(params(), reach()).shape_warning(), "");
  SessionParams stiff = params();
  stiff.weights.elastic = 1.0;
  const std::string warning = SkillSession(stiff, reach()).shape_warning();
  EXPECT_EQ(warning.rfind("w_elastic 1 pulls a plan of 50 nodes straight: ", 0), 0u) << warning;
}

TEST(SkillSession, ForgetsThePlanInANewRun) {
  SkillSession session(params(), reach());
  const TargetForecast forecast = drifting();
  (void)session.plan(at(2, 1.0), &forecast);
  session.reset();
  EXPECT_EQ(session.plan(at(2, 1.0), nullptr).status, SkillStatus::kNoPlan);
}

}  // namespace
}  // namespace elte_planner
