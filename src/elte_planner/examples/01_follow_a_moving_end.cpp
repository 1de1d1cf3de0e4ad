// SPDX-License-Identifier: BSD-3-Clause
//
// A demonstrated arc is executed while the point it shall reach drifts away: before every node the
// rest is planned anew. The executed part is never touched, the end is met within 1 cm.
#include <cmath>
#include <cstdio>

#include "elte_planner/endpoint_solver.hpp"

int main() {
  constexpr Eigen::Index kNodes = 50;
  Eigen::MatrixXd arc(kNodes, 2);  // m
  for (Eigen::Index k = 0; k < kNodes; ++k) {
    const double angle = M_PI * static_cast<double>(k) / static_cast<double>(kNodes - 1);
    arc.row(k) << -0.4 * std::cos(angle), 0.4 * std::sin(angle);
  }
  const elte_planner::EndpointSolver solver(arc, elte_planner::ElteWeights{});

  Eigen::MatrixXd plan = arc;
  Eigen::Vector2d goal = arc.row(kNodes - 1).transpose();
  for (Eigen::Index executed = 2; executed < kNodes; ++executed) {
    goal += Eigen::Vector2d(0.002, 0.001);
    solver.solve(executed, goal, 0.01, plan);
  }
  const double miss = (plan.row(kNodes - 1).transpose() - goal).lpNorm<1>();
  std::printf("goal (%.3f, %.3f) m, missed by %.4f m\n", goal.x(), goal.y(), miss);
  return miss <= 0.01 + 1e-12 ? 0 : 1;
}
