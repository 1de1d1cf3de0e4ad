// SPDX-License-Identifier: BSD-3-Clause
// Times of our solvers and their error against 113-bit arithmetic, as JSON for elte_benchmark.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "elte_planner/edit_problem.hpp"
#include "elte_planner/endpoint_solver.hpp"
#include "quad_reference.hpp"
#include "random_problems.hpp"

namespace {

using namespace elte_planner;

template <typename Solve>
double median_microseconds(Solve&& solve, int repetitions) {
  constexpr int kBatches = 31;
  std::vector<double> times;
  for (int batch = 0; batch < kBatches; ++batch) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < repetitions; ++i) solve();
    const std::chrono::duration<double, std::micro> elapsed =
        std::chrono::steady_clock::now() - start;
    times.push_back(elapsed.count() / repetitions);
  }
  std::nth_element(times.begin(), times.begin() + kBatches / 2, times.end());
  return times[kBatches / 2];
}

nlohmann::json row(const char* solver, Eigen::Index nodes, double radius, double microseconds,
                   double error) {
  return {{"solver", solver},
          {"nodes", nodes},
          {"radius_m", radius},
          {"median_us", microseconds},
          {"max_relative_error", error}};
}

void end_point(Eigen::Index nodes, double radius, nlohmann::json& rows) {
  std::mt19937 random(1);
  const Eigen::MatrixXd zeta = random_demonstration(nodes, 3, random);
  Eigen::VectorXd goal = zeta.row(nodes - 1).transpose();
  goal += Eigen::Vector3d(0.1, -0.05, 0.02);
  const EndpointSolver solver(zeta, {});
  Eigen::MatrixXd plan = zeta;
  const int repetitions = std::max(20, static_cast<int>(200000 / nodes));
  const double time =
      median_microseconds([&] { solver.solve(2, goal, radius, plan); }, repetitions);
  const double gains = median_microseconds([&] { EndpointSolver(zeta, {}); }, 1);

  const QuadReference reference(zeta, {});
  Eigen::MatrixXd expected = reference.solve(2, nodes, zeta);
  Eigen::VectorXd end = expected.row(nodes - 1).transpose();
  project_on_l1_ball(goal, radius, end);
  expected.row(nodes - 1) = end.transpose();
  expected = reference.solve(2, nodes - 1, expected);
  const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff());
  rows.push_back(row("elte", nodes, radius, time, (plan - expected).cwiseAbs().maxCoeff() / scale));
  rows.push_back(row("elte gains, once", nodes, radius, gains, 0.0));
}

// Half of a drawn path is executed; balls around a detour keep the rest off an obstacle.
nlohmann::json obstacle() {
  constexpr Eigen::Index kNodes = 100;
  EditProblem problem;
  problem.zeta.resize(kNodes, 2);
  for (Eigen::Index k = 0; k < kNodes; ++k) {
    const double s = static_cast<double>(k) / static_cast<double>(kNodes - 1);
    problem.zeta.row(k) << 10.0 * s, 2.0 * std::sin(M_PI * s);
  }
  problem.fixed = problem.zeta.topRows(50);
  for (Eigen::Index k = 50; k < kNodes; ++k) {
    const double room = 0.3 + 0.02 * static_cast<double>(k - 50);
    problem.constraints.push_back(PointConstraint::ball(k, problem.zeta.row(k).transpose(), room));
  }
  problem.constraints.push_back(PointConstraint::equality(kNodes - 1, Eigen::Vector2d(10.0, 1.0)));
  EditSolver solver;
  EditSolution solution;
  const double time = median_microseconds([&] { solver.solve(problem, {}, solution); }, 200);
  std::fprintf(stderr, "obstacle case: %d active facets\n", solution.active_facets);
  return row("elte, 2-D obstacle balls (KKT residual)", kNodes, 0.0, time, solution.kkt_residual);
}

}  // namespace

int main() {
  nlohmann::json rows = nlohmann::json::array();
  for (const Eigen::Index nodes : {50, 100, 200, 1000, 10000}) {
    for (const double radius : {0.0, 0.02}) end_point(nodes, radius, rows);
  }
  rows.push_back(obstacle());
  std::cout << rows.dump(1) << "\n";
  return 0;
}
