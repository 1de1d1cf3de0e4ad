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
                          "sphere 1 2 nan 0.1", "sphere 1 2 3 -0.1", "box on_target 1 2 3 1 1 1",
                          "sphere on_robot 1 2 3 0.1", "box 1 2 3 1 1 1e9", "sphere"}) {
    EXPECT_THROW((void)obstacles_from(bad), std::invalid_argument) << bad;
  }
  std::string many;
  for (int i = 0; i < 9; ++i) many += "sphere 1 2 3 0.1;";
  EXPECT_THROW((void)obstacles_from(many), std::invalid_argument);
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

// Fault 22: an obstacle over the goal, no way past it -> the last plan is sent as KEPT
TEST(SkillSession, KeepsTheLastPlanWhereNoWayIsFound) {
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
  EXPECT_EQ(kept.status, SkillStatus::kKept);
  EXPECT_NE(kept.message.find("no way found"), std::string::npos) << kept.message;
  EXPECT_EQ(kept.poses.back().pose.position, before.poses.back().pose.position);
}

TEST(SessionParams, RefuseObstaclesForPlannersThatKeepNoClearance) {
  SessionParams bad = params();
  bad.obstacles = obstacles_from("sphere 1 0 0 0.1");
  bad.clearance = 0.02;
  EXPECT_NO_THROW(bad.validate());
  bad.planner = "dmp";
  EXPECT_THROW(bad.validate(), std::invalid_argument);
  bad.planner = "elte";
  bad.clearance = 0.0;
  EXPECT_THROW(bad.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
