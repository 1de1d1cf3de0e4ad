// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/obstacle_avoidance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "random_problems.hpp"

namespace elte_planner {
namespace {

using Index = Eigen::Index;

double distance(const Obstacle& obstacle, const Eigen::VectorXd& x) {
  const Eigen::VectorXd offset = (x - obstacle.centre).cwiseAbs();
  if (obstacle.shape == Obstacle::Shape::kDisc) return offset.norm() - obstacle.radius;
  return (offset - obstacle.half_widths).cwiseMax(0.0).norm();
}

// Of points close together on all segments from row `first` on.
double sampled_clearance(const Eigen::MatrixXd& y, Index first,
                         const std::vector<Obstacle>& obstacles) {
  constexpr int kSamples = 500;
  double least = 1e300;
  for (const Obstacle& obstacle : obstacles) {
    for (Index k = first; k + 1 < y.rows(); ++k) {
      for (int i = 0; i <= kSamples; ++i) {
        const double t = static_cast<double>(i) / kSamples;
        const Eigen::VectorXd x = ((1.0 - t) * y.row(k) + t * y.row(k + 1)).transpose();
        least = std::min(least, distance(obstacle, x));
      }
    }
  }
  return least;
}

Obstacle random_obstacle(const Eigen::VectorXd& place, std::mt19937& random) {
  std::uniform_real_distribution<double> size(0.01, 0.15);
  const Eigen::VectorXd centre = place + random_vector(place.size(), 0.05, random);
  if (std::bernoulli_distribution(0.5)(random)) return Obstacle::disc(centre, size(random));
  return Obstacle::box(centre,
                       Eigen::VectorXd::NullaryExpr(place.size(), [&] { return size(random); }));
}

AvoidanceProblem random_problem(std::mt19937& random) {
  const Index nodes = std::uniform_int_distribution<Index>(12, 60)(random);
  const Index d = std::uniform_int_distribution<Index>(2, 3)(random);
  AvoidanceProblem problem;
  problem.edit.zeta = random_demonstration(nodes, d, random);
  problem.edit.fixed = problem.edit.zeta.topRows(3);
  problem.edit.constraints = {PointConstraint::ball(
      nodes - 1, problem.edit.zeta.row(nodes - 1).transpose() + random_vector(d, 0.1, random),
      0.02)};
  for (int i = 0; i < std::uniform_int_distribution<int>(1, 3)(random); ++i) {
    const Index k = std::uniform_int_distribution<Index>(nodes / 3, nodes - 4)(random);
    problem.obstacles.push_back(random_obstacle(problem.edit.zeta.row(k).transpose(), random));
  }
  problem.clearance = 0.02;
  return problem;
}

// A straight demonstration along x from 0 to 1.
AvoidanceProblem straight(Index nodes) {
  AvoidanceProblem problem;
  problem.edit.zeta = Eigen::MatrixXd::Zero(nodes, 2);
  problem.edit.zeta.col(0).setLinSpaced(nodes, 0.0, 1.0);
  problem.edit.fixed = problem.edit.zeta.topRows(2);
  problem.edit.constraints = {PointConstraint::equality(nodes - 1, Eigen::Vector2d(1.0, 0.0))};
  problem.clearance = 0.03;
  return problem;
}

TEST(Obstacle, DistanceFromASegmentIsThatOfItsNearestSample) {
  std::mt19937 random(1);
  int apart = 0;
  for (int i = 0; i < 2000; ++i) {
    const Index d = std::uniform_int_distribution<Index>(1, 4)(random);
    const Obstacle obstacle = random_obstacle(Eigen::VectorXd::Zero(d), random);
    Eigen::MatrixXd ends(2, d);
    for (const Index k : {0, 1}) ends.row(k) = random_vector(d, 0.3, random).transpose();
    const Separation found = separation(obstacle, ends.row(0).transpose(), ends.row(1).transpose());
    const double sampled = std::max(sampled_clearance(ends, 0, {obstacle}), 0.0);
    ASSERT_LE(found.distance, sampled + 1e-12) << i;
    ASSERT_GE(found.distance, sampled - 0.002) << i;
    ASSERT_EQ(found.normal.size() > 0, found.distance > 0.0) << i;
    if (found.distance == 0.0) continue;
    ++apart;
    ASSERT_NEAR(found.normal.norm(), 1.0, 1e-12) << i;
    // The plane through the obstacle's point nearest to the segment separates the two.
    const double plane = found.normal.dot(obstacle.centre) + obstacle.reach(found.normal);
    for (const Index k : {0, 1}) {
      ASSERT_GE(ends.row(k).dot(found.normal), plane + found.distance - 1e-12) << i;
    }
  }
  EXPECT_GT(apart, 1000);
  EXPECT_LT(apart, 1900);
}

TEST(ObstacleAvoidance, KeepsTheClearanceAllAlongThePolyline) {
  std::mt19937 random(2);
  int bent = 0;
  int not_found = 0;
  for (int i = 0; i < 300; ++i) {
    const AvoidanceProblem problem = random_problem(random);
    const AvoidanceSolution solution = avoid_obstacles(problem);
    if (solution.status == AvoidanceStatus::kNotFound) {
      ++not_found;
      ASSERT_NE(solution.message.find("obstacle"), std::string::npos);
      continue;
    }
    ASSERT_EQ(solution.status, AvoidanceStatus::kSolved) << i << ": " << solution.message;
    const Eigen::MatrixXd& y = solution.plan.y;
    ASSERT_EQ(y.topRows(3), problem.edit.fixed);
    const double sampled = sampled_clearance(y, 2, problem.obstacles);
    ASSERT_GE(sampled, problem.clearance - 1e-11) << i;
    ASSERT_GE(solution.clearance, problem.clearance - 1e-11) << i;
    ASSERT_LE(solution.clearance, sampled + 1e-11) << i;
    const PointConstraint& end = problem.edit.constraints[0];
    ASSERT_LE((y.row(end.node).transpose() - end.centre).lpNorm<1>(), end.radius + 1e-12) << i;
    if (solution.passes > 1) ++bent;
  }
  EXPECT_GT(bent, 150);
  EXPECT_LT(not_found, 45);
}

TEST(ObstacleAvoidance, ProtectsASegmentWhoseNodesAreFarApart) {
  AvoidanceProblem problem = straight(6);  // the obstacle fits between two nodes
  problem.obstacles = {Obstacle::disc(Eigen::Vector2d(0.5, 0.01), 0.03)};
  const AvoidanceSolution solution = avoid_obstacles(problem);
  ASSERT_EQ(solution.status, AvoidanceStatus::kSolved) << solution.message;
  EXPECT_GE(sampled_clearance(solution.plan.y, 1, problem.obstacles), problem.clearance - 1e-11);
  EXPECT_NEAR(solution.clearance, problem.clearance, 1e-11);
}

TEST(ObstacleAvoidance, PassesOnTheSideOfLessEnergy) {
  for (const double offset : {-0.05, 0.05}) {
    AvoidanceProblem problem = straight(50);
    problem.obstacles = {Obstacle::box(Eigen::Vector2d(0.5, offset), Eigen::Vector2d(0.1, 0.1))};
    const AvoidanceSolution solution = avoid_obstacles(problem);
    ASSERT_EQ(solution.status, AvoidanceStatus::kSolved) << solution.message;
    EXPECT_LT(solution.plan.y.col(1).sum() * offset, 0.0);
    EXPECT_EQ(solution.choices, 3);
  }
}

TEST(ObstacleAvoidance, RestsWhereEveryTouchedPlaneIsOptimal) {
  AvoidanceProblem problem = straight(40);
  problem.obstacles = {Obstacle::disc(Eigen::Vector2d(0.5, 0.02), 0.1)};
  const AvoidanceSolution solution = avoid_obstacles(problem);
  ASSERT_EQ(solution.status, AvoidanceStatus::kSolved);
  EXPECT_LE(solution.last_move, 1e-9);
  EXPECT_LE(solution.plan.kkt_residual, 1e-12);
  EXPECT_FALSE(solution.plan.active.empty());
}

TEST(ObstacleAvoidance, LeavesAPlanAloneThatIsClear) {
  AvoidanceProblem problem = straight(30);
  problem.obstacles = {Obstacle::disc(Eigen::Vector2d(0.5, 0.5), 0.1)};
  const AvoidanceSolution solution = avoid_obstacles(problem);
  ASSERT_EQ(solution.status, AvoidanceStatus::kSolved);
  EXPECT_LE((solution.plan.y - solve(problem.edit).y).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_EQ(solution.choices, 1);
}

TEST(ObstacleAvoidance, FindsNoWayToAGoalOrFromAStartInsideAnObstacle) {
  for (const double x : {1.0, 0.03}) {
    AvoidanceProblem problem = straight(30);
    problem.obstacles = {Obstacle::disc(Eigen::Vector2d(0.5, 1.0), 0.1),
                         Obstacle::disc(Eigen::Vector2d(x, 0.0), 0.05)};
    const AvoidanceSolution solution = avoid_obstacles(problem);
    EXPECT_EQ(solution.status, AvoidanceStatus::kNotFound) << x;
    EXPECT_NE(solution.message.find("obstacle 1"), std::string::npos) << solution.message;
  }
}

TEST(ObstacleAvoidance, ATurnedBoxIsAsFarAsTheSameScenePutStraight) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const auto point = [&] { return Eigen::Vector2d(uniform(random), uniform(random)); };
    const Eigen::Matrix2d turn =
        Eigen::Rotation2D<double>(3.0 * uniform(random)).toRotationMatrix();
    const Obstacle straight_box = Obstacle::box(point(), Eigen::Vector2d(0.3, 0.1));
    const Obstacle turned =
        Obstacle::box(turn * straight_box.centre, Eigen::Vector2d(0.3, 0.1), turn);
    const Eigen::Vector2d from = 2.0 * point(), to = 2.0 * point();
    const Separation expected = separation(straight_box, from, to);
    const Separation found = separation(turned, turn * from, turn * to);
    ASSERT_NEAR(found.distance, expected.distance, 1e-12);
    if (expected.distance > 0.0) {
      ASSERT_LE((found.normal - turn * expected.normal).norm(), 1e-9);
    }
    ASSERT_NEAR(turned.reach(turn * from), straight_box.reach(from), 1e-12);
  }
}

// At the start it is far off, and in the way when the plan comes there.
TEST(ObstacleAvoidance, KeepsClearOfWhereAnObstacleIsAtTheTimeOfEachSegment) {
  AvoidanceProblem problem = straight(40);
  MovingObstacle places;
  for (int k = 0; k < 40; ++k) {
    places.push_back(Obstacle::disc(Eigen::Vector2d(0.5, 0.02 + 0.05 * std::abs(k - 20)), 0.1));
  }
  problem.moving = {places};
  const AvoidanceSolution solution = avoid_obstacles(problem);
  ASSERT_EQ(solution.status, AvoidanceStatus::kSolved) << solution.message;
  const double found = plan_clearance(solution.plan.y, problem.edit.fixed.rows(), {}, {places});
  EXPECT_GE(found, problem.clearance - 1e-9);
  EXPECT_LE(found, problem.clearance + 1e-3);
  problem.moving[0].pop_back();
  EXPECT_THROW((void)avoid_obstacles(problem), std::invalid_argument);
}

TEST(ObstacleAvoidance, InvalidObstaclesAreRefused) {
  const auto refused = [](auto&& change) {
    AvoidanceProblem problem = straight(10);
    problem.obstacles = {Obstacle::disc(Eigen::Vector2d(0.5, 0.5), 0.1),
                         Obstacle::box(Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(0.1, 0.1))};
    change(problem);
    EXPECT_THROW((void)avoid_obstacles(problem), std::invalid_argument);
  };
  EXPECT_NO_THROW((void)avoid_obstacles(straight(10)));
  refused([](AvoidanceProblem& p) { p.clearance = 0.0; });
  refused([](AvoidanceProblem& p) { p.clearance = std::nan(""); });
  refused([](AvoidanceProblem& p) { p.obstacles[0].radius = -0.1; });
  refused([](AvoidanceProblem& p) { p.obstacles[0].radius = std::nan(""); });
  refused([](AvoidanceProblem& p) { p.obstacles[0].centre.conservativeResize(1); });
  refused([](AvoidanceProblem& p) { p.obstacles[0].centre[0] = std::nan(""); });
  refused([](AvoidanceProblem& p) { p.obstacles[1].half_widths[1] = -0.1; });
  refused([](AvoidanceProblem& p) { p.obstacles[1].axes = Eigen::Matrix2d::Ones(); });
  refused([](AvoidanceProblem& p) { p.obstacles[1].half_widths.conservativeResize(1); });
}

}  // namespace
}  // namespace elte_planner
