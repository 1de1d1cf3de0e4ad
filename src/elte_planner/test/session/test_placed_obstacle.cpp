// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/placed_obstacle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "reach_skill.hpp"

namespace elte_planner {
namespace {

TEST(PlacedObstacle, IsReadFromText) {
  const auto read =
      obstacles_from("sphere 1 2 3 0.5; box 0 0 1 0.1 0.2 0.3;sphere on_target 0 1 0 0.1;");
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[0].shape.centre, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(read[0].shape.radius, 0.5);
  EXPECT_EQ(read[1].shape.half_widths, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_TRUE(read[2].on_target);
  EXPECT_TRUE(obstacles_from("").empty());
  const prf_core::Pose target{
      {5.0, 0.0, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitZ()))};
  const Eigen::Vector3d placed = read[2].in_planning_frame(target).centre;
  EXPECT_LE((placed - Eigen::Vector3d(4.0, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_EQ(read[0].in_planning_frame(target).centre, read[0].shape.centre);
}

// Fault 28: garbage in the planner's obstacles -> refused by name
TEST(PlacedObstacle, RefusesWhatIsNone) {
  for (const char* bad : {"sphere 1 2 3", "sphere 1 2 3 4 5", "ball 1 2 3 0.1", "sphere 1 2 x 0.1",
                          "sphere 1 2 nan 0.1", "sphere 1 2 3 -0.1", "box on_target 1 2 3 1 1",
                          "sphere on_robot 1 2 3 0.1", "box 1 2 3 1 1 1e9", "sphere"}) {
    EXPECT_THROW((void)obstacles_from(bad), std::invalid_argument) << bad;
  }
  std::string many;
  for (int i = 0; i < 9; ++i) many += "sphere 1 2 3 0.1;";
  EXPECT_THROW((void)obstacles_from(many), std::invalid_argument);
}

TEST(PlacedObstacle, ABoxTurnsWithTheTarget) {
  const auto box = obstacles_from("box on_target 1 0 0 0.1 0.2 0.3");
  const prf_core::Pose target{
      {5.0, 0.0, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitZ()))};
  const Obstacle placed = box[0].in_planning_frame(target);
  EXPECT_LE((placed.centre - Eigen::Vector3d(5.0, 1.0, 0.0)).norm(), 1e-12);
  EXPECT_NEAR(placed.reach(Eigen::Vector3d::UnitX()), 0.2, 1e-12);
  const Eigen::Vector3d beside(5.5, 1.0, 0.0);
  EXPECT_NEAR(separation(placed, beside, beside).distance, 0.3, 1e-12);
}

TEST(PlacedVia, IsReadFromTextOrRefused) {
  const auto read = via_points_from("0.5 1 2 3 0.01; 0.25 on_target 0 1 0 0.1");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].node(51), 25);
  EXPECT_FALSE(read[0].on_target);
  EXPECT_TRUE(read[1].on_target);
  EXPECT_EQ(read[1].radius, 0.1);
  for (const char* bad : {"0.5 1 2 3", "0 1 2 3 0.1", "1 1 2 3 0.1", "nan 1 2 3 0.1", "x 1 2 3 0.1",
                          "0.5 on_robot 1 2 3 0.1", "0.5 1 2 3 -0.1", "0.5 1 2 99 0.1"}) {
    EXPECT_THROW((void)via_points_from(bad), std::invalid_argument) << bad;
  }
}

TEST(SkillSession, PassesAViaPointOnTheTarget) {
  SessionParams by = params();
  by.via_points = via_points_from("0.5 on_target -0.5 0.15 -0.2 0.01");
  SkillSession session(by, reach());
  const TargetForecast forecast = resting();
  const SkillResult plan = session.plan(at(2, 2.0), &forecast);
  ASSERT_EQ(plan.status, SkillStatus::kSolved) << plan.message;
  const Eigen::Vector3d place =
      by.via_points[0].in_planning_frame(forecast.predictions[0].target.pose);
  const auto node = static_cast<std::size_t>(by.via_points[0].node(by.nodes));
  EXPECT_LE((plan.poses[node].pose.position - place).lpNorm<1>(), 0.01 + 1e-9);
  by.via_points = via_points_from("0.999 0 0 0 0.1");
  EXPECT_THROW(SkillSession(by, reach()), std::invalid_argument);
}

double clearance_of(const SkillResult& plan, const Obstacle& obstacle) {
  Eigen::MatrixXd path(static_cast<Eigen::Index>(plan.poses.size()), 3);
  for (std::size_t k = 0; k < plan.poses.size(); ++k) {
    path.row(static_cast<Eigen::Index>(k)) = plan.poses[k].pose.position.transpose();
  }
  return polyline_clearance(path, {obstacle});
}

// In the way of reach(), which passes (0.45, 0.1, 0.25) half way.
TEST(SkillSession, KeepsClearOfAnObstacleWhileTheTargetMoves) {
  SessionParams around = params();
  around.approach_length = 0.1;
  around.obstacles = obstacles_from("sphere 0.45 0.1 0.25 0.03");
  around.clearance = 0.02;
  SkillSession session(around, reach());
  for (Eigen::Index frozen = 2; frozen < 50; ++frozen) {
    TargetForecast forecast = drifting();
    for (TargetPrediction& p : forecast.predictions) {
      p.target.pose.position.z() += 0.01 * std::sin(0.5 * static_cast<double>(frozen));
    }
    const SkillResult plan =
        session.plan(at(frozen, 0.04 * static_cast<double>(50 - frozen)), &forecast);
    ASSERT_EQ(plan.status, SkillStatus::kSolved) << frozen << ": " << plan.message;
    ASSERT_GE(clearance_of(plan, around.obstacles[0].shape), 0.02 - 1e-9) << frozen;
  }
}

// The obstacle moves with the target: each segment keeps clear of where it is then.
TEST(SkillSession, KeepsClearOfAnObstacleOnTheMovingTarget) {
  SessionParams around = params();
  around.clearance = 0.02;
  SkillSession session(around, reach());
  const std::vector<PlacedObstacle> seen =
      obstacles_from("box on_target -0.496 0.258 -0.25 0.03 0.03 0.1");
  const TargetForecast forecast = drifting();
  const Progress now = at(2, 1.9);  // all within the forecast's reach
  const SkillResult plan = session.plan(now, &forecast, seen);
  ASSERT_EQ(plan.status, SkillStatus::kSolved) << plan.message;
  double least = 1.0;
  for (std::size_t k = 2; k < plan.poses.size(); ++k) {
    const double before_end = plan.poses.back().time - plan.poses[k].time;
    const auto time = std::max(now.stamp + now.time_to_go - from_seconds(before_end), kStamp);
    const Obstacle there =
        seen[0].in_planning_frame(prf_core::predicted_target(forecast, time).target.pose);
    least = std::min(
        least,
        separation(there, plan.poses[k - 1].pose.position, plan.poses[k].pose.position).distance);
  }
  EXPECT_GE(least, 0.02 - 1e-9);
  EXPECT_LE(least, 0.03);  // it was in the way
}

// Fault 22: an obstacle over the goal, no way past it -> no plan is sent, the execution pauses
TEST(SkillSession, IsBlockedWhereNoWayIsFoundAndKeepsTheLastPlan) {
  SessionParams blocked = params();
  blocked.obstacles = obstacles_from("sphere 0.6 0.1 0.42 0.1");
  blocked.clearance = 0.02;
  SkillSession session(blocked, reach());
  TargetForecast forecast = resting();
  forecast.predictions[0].target.pose.position.y() -= 0.2;
  const SkillResult before = session.plan(at(2, 2.0), &forecast);
  ASSERT_EQ(before.status, SkillStatus::kSolved) << before.message;
  forecast.predictions[0].target.pose.position.y() += 0.3;
  const SkillResult kept = session.plan(at(10, 1.6), &forecast);
  EXPECT_EQ(kept.status, SkillStatus::kBlocked);
  EXPECT_NE(kept.message.find("no way found"), std::string::npos) << kept.message;
  EXPECT_EQ(kept.poses.back().pose.position, before.poses.back().pose.position);
}

TEST(SessionParams, RefuseObstaclesForPlannersThatKeepNoClearance) {
  SessionParams bad = params();
  bad.obstacles = obstacles_from("sphere 1 0 0 0.1");
  bad.clearance = 0.02;
  EXPECT_NO_THROW(bad.validate());
  bad.planner = "elastic_map";
  EXPECT_THROW(bad.validate(), std::invalid_argument);
  bad.planner = "elte";
  bad.clearance = 0.0;
  EXPECT_THROW(bad.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
