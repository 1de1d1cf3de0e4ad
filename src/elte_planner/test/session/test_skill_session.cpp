// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "elte_planner/confidence_radius.hpp"
#include "elte_planner/skill_session.hpp"
#include "reach_skill.hpp"

namespace elte_planner {
namespace {

using prf_core::pose_from;

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
  TargetForecast nothing;
  nothing.stamp = kStamp;
  const TargetForecast lost = drifting(TargetStatus::kLost);
  for (const TargetForecast* forecast : {static_cast<const TargetForecast*>(&nothing), &lost,
                                         static_cast<const TargetForecast*>(nullptr)}) {
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

// demonstration
// kept
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
