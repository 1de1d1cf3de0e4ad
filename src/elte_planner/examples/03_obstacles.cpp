// SPDX-License-Identifier: BSD-3-Clause
//
// A straight reach past a disc and a box: every segment keeps 3 cm of clearance.
#include <cstdio>

#include "elte_planner/obstacle_avoidance.hpp"

int main() {
  using elte_planner::Obstacle;
  constexpr Eigen::Index kNodes = 60;
  elte_planner::AvoidanceProblem problem;
  problem.edit.zeta = Eigen::MatrixXd::Zero(kNodes, 2);  // m
  problem.edit.zeta.col(0).setLinSpaced(kNodes, 0.0, 1.0);
  problem.edit.fixed = problem.edit.zeta.topRows(2);
  problem.edit.constraints = {
      elte_planner::PointConstraint::equality(kNodes - 1, Eigen::Vector2d(1.0, 0.1))};
  problem.obstacles = {Obstacle::disc(Eigen::Vector2d(0.35, 0.03), 0.08),
                       Obstacle::box(Eigen::Vector2d(0.7, -0.02), Eigen::Vector2d(0.05, 0.06))};
  problem.clearance = 0.03;

  const elte_planner::AvoidanceSolution solution = elte_planner::avoid_obstacles(problem);
  if (solution.status != elte_planner::AvoidanceStatus::kSolved) {
    std::printf("%s\n", solution.message.c_str());
    return 1;
  }
  std::printf("clearance %.6f m after %d passes, %d choices of sides\n", solution.clearance,
              solution.passes, solution.choices);
  return solution.clearance >= problem.clearance - 1e-12 ? 0 : 1;
}
