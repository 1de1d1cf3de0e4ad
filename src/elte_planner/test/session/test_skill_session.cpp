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

constexpr std::int64_t kSecond = 1'000'000'000;

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
  return {horizon, target, deviation * deviation * Eigen::Matrix3d::Identity()};
}

// Drifts by 0.1 m/s along y, deviation growing from 1 mm by 10 mm/s.
Forecast drifting(TargetStatus status = TargetStatus::kTracking) {
  Forecast forecast{10 * kSecond, status, {}};
  for (const double horizon : {0.0, 0.5, 1.0, 2.0, 4.0}) {
    forecast.predictions.push_back(
        prediction(horizon, {0.0, 0.1 * horizon, 0.02}, 0.001 + 0.01 * horizon));
    forecast.predictions.back().velocity.y() = 0.1;
  }
  return forecast;
}

Progress at(Eigen::Index frozen, double time_to_go) {
  return {10 * kSecond + kSecond / 10, 10 * kSecond, frozen, time_to_go};
}

double end_distance(const SkillResult& result, const Pose& goal) {
  return (result.poses.back().pose.position - goal.position).lpNorm<1>();
}

TEST(SkillSession, EndsAtTheDemonstratedPoseRelativeToThePredictedTarget) {
  SkillSession session(params(), reach());
  const Forecast forecast = drifting();
  const SkillResult result = session.plan(at(2, 0.65), &forecast);
  ASSERT_EQ(result.status, SkillStatus::kSolved) << result.message;
  ASSERT_EQ(result.poses.size(), 50u);
  // 0.65 s to go and a forecast 0.1 s old: the target in 0.75 s.
  const Pose target = prediction(0.75, {0.0, 0.075, 0.02}, 0.0).target;
  const Pose goal = pose_from(target.isometry() * reach().goal_in_target().isometry());
  EXPECT_LE(end_distance(result, goal), result.radius + 1e-12);
  EXPECT_LT(result.poses.back().pose.orientation.angularDistance(goal.orientation), 1e-7);
  EXPECT_LE(result.kkt_residual, 1e-14);
  EXPECT_EQ(result.poses[1].time, reach().resampled_by_arc_length(50).samples()[1].time);
}

TEST(PredictedTarget, FollowsASineBetweenItsPredictions) {
  Forecast forecast{0, TargetStatus::kTracking, {}};
  for (const double t : {0.0, 0.5, 1.0, 2.0}) {
    forecast.predictions.push_back(prediction(t, {0.1 * std::sin(2.4 * t), 0.0, 0.0}, 0.01));
    forecast.predictions.back().velocity.x() = 0.24 * std::cos(2.4 * t);
  }
  for (const double t : {0.25, 0.75, 1.25, 1.5, 1.75}) {
    const double x = predicted_target(forecast, t)->target.position.x() - 1.0;
    EXPECT_NEAR(x, 0.1 * std::sin(2.4 * t), 0.009) << t;
  }
}

TEST(SkillSession, BringsTheApproachWithTheTargetAsItIsAtTheTimeOfEachNode) {
  SessionParams bound = params();
  bound.approach_length = 0.15;
  SkillSession session(bound, reach());
  const Forecast forecast = drifting();
  const SkillResult result = session.plan(at(10, 1.6), &forecast);
  ASSERT_EQ(result.status, SkillStatus::kSolved) << result.message;
  EXPECT_LE(result.kkt_residual, 1e-12);
  const auto& shown = session.demonstration().samples();
  int checked = 0;
  for (std::size_t k = 48; k >= 10; --k, ++checked) {
    const double distance = (shown[k].pose.position - shown[49].pose.position).norm();
    if (distance > bound.approach_length) break;
    const double time = std::max(1.7 - (shown[49].time - shown[k].time), 0.0);
    const Pose moved = prediction(time, {0.0, 0.1 * time, 0.02}, 0.0).target;
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
  const Forecast forecast = drifting();
  EXPECT_EQ(near.plan(at(2, 1.9), &forecast).poses.back().pose.position,
            far.plan(at(2, 50.0), &forecast).poses.back().pose.position);
}

TEST(SkillSession, OpensTheBallWithTheUncertaintyBetweenItsBounds) {
  SessionParams wide = params();
  wide.radius_min = 0.0;
  wide.radius_max = 1.0;
  SkillSession session(wide, reach());
  const Forecast forecast = drifting();
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
  const Forecast forecast = drifting();
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
  const Forecast nothing{10 * kSecond, TargetStatus::kNoTarget, {}};
  const Forecast lost = drifting(TargetStatus::kLost);
  for (const Forecast* forecast : {&nothing, &lost, static_cast<const Forecast*>(nullptr)}) {
    const SkillResult result = session.plan(at(2, 1.0), forecast);
    EXPECT_EQ(result.status, SkillStatus::kNoPlan);
    EXPECT_TRUE(result.poses.empty());
    EXPECT_FALSE(result.message.empty());
  }
}

TEST(SkillSession, KeepsTheLastPlanWhenTheForecastIsOfNoUse) {
  SkillSession session(params(), reach());
  const Forecast good = drifting();
  const SkillResult first = session.plan(at(2, 1.0), &good);

  std::vector<Forecast> useless(6, good);
  useless[0].status = TargetStatus::kLost;
  useless[1].predictions.clear();
  useless[2].predictions[1].target.position.x() = std::nan("");
  useless[3].predictions[1].target.orientation.coeffs().setZero();
  useless[4].predictions[0].covariance = -Eigen::Matrix3d::Identity();
  useless[4].predictions.resize(1);
  useless[5].predictions[2].horizon = 0.5;
  for (const Forecast& forecast : useless) {
    const SkillResult result = session.plan(at(10, 0.6), &forecast);
    EXPECT_EQ(result.status, SkillStatus::kKept);
    EXPECT_FALSE(result.message.empty());
    ASSERT_EQ(result.poses.size(), first.poses.size());
    for (std::size_t k = 0; k < first.poses.size(); ++k) {
      EXPECT_EQ(result.poses[k].pose.position, first.poses[k].pose.position);
    }
  }
  EXPECT_EQ(session.plan(at(10, std::nan("")), &good).status, SkillStatus::kKept);
  EXPECT_EQ(session.plan(at(10, 0.6), nullptr).status, SkillStatus::kKept);
}

TEST(SkillSession, PlansOnWhileTheForecastCoasts) {
  SkillSession session(params(), reach());
  const Forecast coasting = drifting(TargetStatus::kCoasting);
  EXPECT_EQ(session.plan(at(2, 1.0), &coasting).status, SkillStatus::kSolved);
}

TEST(SkillSession, SaysTheSlackWhenAllNodesAreFrozen) {
  SkillSession session(params(), reach());
  const Forecast forecast = drifting();
  (void)session.plan(at(2, 2.0), &forecast);
  const SkillResult result = session.plan(at(1000, 0.0), &forecast);
  EXPECT_EQ(result.status, SkillStatus::kRelaxed);
  EXPECT_EQ(result.frozen, 50);
  EXPECT_GT(result.slack, 0.1);
}

TEST(SkillSession, OpensTheRadiusWhenTheTargetIsBeyondReach) {
  SessionParams slow = params();
  slow.max_step = 0.02;
  SkillSession session(slow, reach());
  Forecast forecast = drifting();
  ASSERT_EQ(session.plan(at(2, 1.0), &forecast).status, SkillStatus::kSolved);
  for (TargetPrediction& p : forecast.predictions) p.target.position.x() += 0.5;
  const SkillResult result = session.plan(at(40, 0.2), &forecast);
  ASSERT_EQ(result.status, SkillStatus::kRelaxed) << result.message;
  EXPECT_FALSE(result.message.empty());
  EXPECT_GT(result.slack, 0.1);
  for (std::size_t k = 40; k < 50; ++k) {
    EXPECT_LE((result.poses[k].pose.position - result.poses[k - 1].pose.position).lpNorm<1>(),
              0.02 + 1e-12);
  }
}

TEST(SkillSession, KeepsTheLastPlanWhenASolveFails) {
  SkillSession session(params(), reach());
  const Forecast forecast = drifting();
  const SkillResult before = session.plan(at(2, 1.0), &forecast);
  Forecast absurd = forecast;
  for (TargetPrediction& p : absurd.predictions) p.target.position.setConstant(1e308);
  const SkillResult kept = session.plan(at(10, 0.8), &absurd);
  ASSERT_EQ(kept.status, SkillStatus::kKept);
  EXPECT_FALSE(kept.message.empty());
  EXPECT_EQ(kept.poses.back().pose.position, before.poses.back().pose.position);
}

TEST(SkillSession, AdaptsOnceToTheFirstTrackedTarget) {
  SessionParams blind = params();
  blind.adaptation = Adaptation::kOnce;
  SkillSession session(blind, reach());
  const Forecast coasting = drifting(TargetStatus::kCoasting);
  EXPECT_EQ(session.plan(at(2, 1.0), &coasting).status, SkillStatus::kNoPlan);
  const Forecast first = drifting();
  const SkillResult adapted = session.plan(at(2, 1.0), &first);
  ASSERT_EQ(adapted.status, SkillStatus::kSolved);
  const Pose goal =
      pose_from(first.predictions[0].target.isometry() * reach().goal_in_target().isometry());
  EXPECT_LE(end_distance(adapted, goal), adapted.radius + 1e-12);

  Forecast moved = first;
  for (TargetPrediction& p : moved.predictions) p.target.position.x() += 0.2;
  const Forecast lost = drifting(TargetStatus::kLost);
  for (const Forecast* later : {static_cast<const Forecast*>(&moved), &lost}) {
    const SkillResult repeated = session.plan(at(30, 0.3), later);
    EXPECT_EQ(repeated.status, SkillStatus::kSolved);
    for (std::size_t k = 0; k < 50; ++k) {
      EXPECT_EQ(repeated.poses[k].pose.position, adapted.poses[k].pose.position);
    }
  }
}

TEST(SkillSession, ForgetsThePlanInANewRun) {
  SkillSession session(params(), reach());
  const Forecast forecast = drifting();
  (void)session.plan(at(2, 1.0), &forecast);
  session.reset();
  EXPECT_EQ(session.plan(at(2, 1.0), nullptr).status, SkillStatus::kNoPlan);
}

TEST(SessionParams, RefuseWhatIsOutOfRangeByName) {
  const auto refused = [](const std::string& name, auto&& change) {
    SessionParams bad = params();
    change(bad);
    try {
      SkillSession session(bad, reach());
      FAIL() << name << " accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  refused("planner", [](SessionParams& p) { p.planner = "bezier"; });
  refused("nodes", [](SessionParams& p) { p.nodes = 2; });
  refused("nodes", [](SessionParams& p) { p.nodes = -1; });
  refused("w_elastic", [](SessionParams& p) { p.weights.elastic = -1.0; });
  refused("w_bending", [](SessionParams& p) { p.weights.bending = std::nan(""); });
  refused("max_step", [](SessionParams& p) { p.max_step = -0.1; });
  refused("max_step", [](SessionParams& p) {
    p.planner = "dmp";
    p.max_step = 0.1;
  });
  refused("horizon_max", [](SessionParams& p) { p.horizon_max = std::nan(""); });
  refused("confidence", [](SessionParams& p) { p.confidence = 1.0; });
  refused("radius_min", [](SessionParams& p) { p.radius_min = -0.1; });
  refused("approach_length", [](SessionParams& p) { p.approach_length = -0.1; });
  refused("radius_max", [](SessionParams& p) { p.radius_max = 0.0005; });
}

}  // namespace
}  // namespace elte_planner
