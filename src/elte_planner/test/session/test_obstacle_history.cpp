// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/obstacle_history.hpp"

#include <gtest/gtest.h>

namespace elte_planner {
namespace {

using std::chrono::seconds;

std::vector<PlacedObstacle> spheres(std::size_t count) {
  return {count, PlacedObstacle{Obstacle::disc(Eigen::Vector3d::Zero(), 0.1)}};
}

TEST(ObstacleHistory, GivesTheSetOfTheStampInWhateverOrderTheyCome) {
  ObstacleHistory early, late;
  early.add(seconds(0), spheres(1));
  early.add(seconds(5), spheres(2));
  EXPECT_EQ(early.at(seconds(4)).size(), 1U);
  late.add(seconds(5), spheres(2));
  late.add(seconds(0), spheres(1));
  EXPECT_EQ(late.at(seconds(4)).size(), 1U);
  EXPECT_EQ(late.at(seconds(5)).size(), 2U);
  EXPECT_EQ(late.at(seconds(50)).size(), 2U);
  EXPECT_TRUE(ObstacleHistory().at(seconds(1)).empty());
}

TEST(ObstacleHistory, ForgetsInANewRunWhatIsStampedLater) {
  ObstacleHistory history;
  history.add(seconds(0), spheres(1));
  history.add(seconds(5), spheres(2));
  history.begin_run(seconds(1));
  EXPECT_EQ(history.at(seconds(9)).size(), 1U);
}

}  // namespace
}  // namespace elte_planner
