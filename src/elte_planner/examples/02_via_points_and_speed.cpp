// SPDX-License-Identifier: BSD-3-Clause
//
// Via-points, a corridor and a bound on the steps; what each constraint costs.
#include <cmath>
#include <cstdio>
#include <limits>

#include "elte_planner/edit_problem.hpp"

int main() {
  using elte_planner::PointConstraint;
  constexpr Eigen::Index kNodes = 50;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  elte_planner::EditProblem problem;
  problem.zeta.resize(kNodes, 2);  // m
  for (Eigen::Index k = 0; k < kNodes; ++k) {
    const double s = static_cast<double>(k) / static_cast<double>(kNodes - 1);
    problem.zeta.row(k) << s, 0.2 * std::sin(M_PI * s);
  }
  problem.fixed = problem.zeta.topRows(2);
  problem.constraints = {
      PointConstraint::ball(25, Eigen::Vector2d(0.5, 0.3), 0.02),  // near a point
      PointConstraint::box(40, Eigen::Vector2d(0, 0),
                           Eigen::Vector2d(kInfinity, 0.05)),               // |y| <= 0.05
      PointConstraint::equality(kNodes - 1, Eigen::Vector2d(1.05, -0.05)),  // exactly there
  };
  problem.max_step = 0.05;  // l1 norm, per node

  const elte_planner::EditSolution solution = elte_planner::solve(problem);
  if (solution.status != elte_planner::EditStatus::kSolved) {
    std::printf("%s\n", solution.message.c_str());
    return 1;
  }
  std::printf("energy %.6f, optimal to %.1e\n", solution.energy, solution.kkt_residual);
  for (const int i : solution.active) {
    std::printf("constraint %d holds with force (%.4f, %.4f)\n", i, solution.forces(i, 0),
                solution.forces(i, 1));
  }

  problem.max_step = 0.03;  // too slow to get there
  const elte_planner::EditSolution hurried = elte_planner::solve(problem);
  std::printf("slower: %s\n", hurried.message.c_str());
  return hurried.status == elte_planner::EditStatus::kInfeasible ? 0 : 1;
}
