// SPDX-License-Identifier: BSD-3-Clause
// Times of our solvers and their error against 113-bit arithmetic, as JSON for elte_benchmark. The
// argument is recorded_requests.json.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "elte_planner/edit_problem.hpp"
#include "elte_planner/endpoint_solver.hpp"
#include "elte_planner/skill_planner.hpp"
#include "elte_planner/skill_session.hpp"
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

// Each solve timed alone, in processor time of the thread: other programs do not count.
struct Times {
  template <typename Solve>
  void add(Solve&& solve) {
    const double start = now();
    solve();
    microseconds.push_back(now() - start);
  }

  static double now() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
  }

  nlohmann::json row(const char* solver, double error) {
    std::sort(microseconds.begin(), microseconds.end());
    const std::size_t count = microseconds.size();
    nlohmann::json result = ::row(solver, 50, 0.02, microseconds[count / 2], error);
    result["p99_us"] = microseconds[count * 99 / 100];
    return result;
  }

  std::vector<double> microseconds;
};

Eigen::MatrixXd matrix(const nlohmann::json& rows) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()), 3);
  for (Eigen::Index k = 0; k < result.rows(); ++k) {
    for (Eigen::Index j = 0; j < 3; ++j) result(k, j) = rows.at(k).at(j).get<double>();
  }
  return result;
}

PlanRequest request_from(const nlohmann::json& recorded, const Eigen::MatrixXd& zeta) {
  PlanRequest request;
  request.frozen = recorded.at("frozen").get<Eigen::Index>();
  request.previous = zeta;
  request.previous.middleRows(request.frozen - 2, 2) = matrix(recorded.at("fixed"));
  for (const auto& entry : recorded.at("balls")) {
    const Eigen::Vector3d centre(entry.at(1), entry.at(2), entry.at(3));
    request.approach.push_back({entry.at(0), centre, entry.at(4)});
  }
  request.goal = request.approach.back().centre;
  request.radius = request.approach.back().radius;
  request.approach.pop_back();
  return request;
}

constexpr int kRepetitions = 100;

// What skill_planner_node solves: a ball at every node of the approach. Cold, every time.
void node_problems(const nlohmann::json& recorded, nlohmann::json& rows) {
  const Eigen::MatrixXd zeta = matrix(recorded.at("zeta"));
  std::vector<PlanRequest> requests;
  for (const auto& entry : recorded.at("requests")) requests.push_back(request_from(entry, zeta));
  const struct {
    const char* name;
    double max_step;
  } cases[] = {{"elte, node's problem (KKT residual)", SolveLimits{}.max_step},
               {"elte, node's problem, steps <= 0.08 m", 0.08}};
  for (const auto& [name, max_step] : cases) {
    const auto planner = make_skill_planner("elte", zeta, {}, {max_step, 2000});
    Times times;
    double residual = 0.0;
    int failed = 0;
    for (int i = 0; i < kRepetitions; ++i) {
      for (const PlanRequest& request : requests) {
        PlanResult result;
        times.add([&] { result = planner->plan(request); });
        failed += result.status == PlanStatus::kFailed ? 1 : 0;
        residual = std::max(residual, result.kkt_residual);
      }
    }
    std::fprintf(stderr, "%s: %d of %zu have no plan\n", name, failed / kRepetitions,
                 requests.size());
    rows.push_back(times.row(name, residual));
  }
}

// From forecast and progress to the poses, for a forecast whose deviation grows like that of a
// stepping robot, at every cursor.
nlohmann::json whole_plan(const nlohmann::json& recorded) {
  const Eigen::MatrixXd zeta = matrix(recorded.at("zeta"));
  const prf_core::Stamp stamp = std::chrono::seconds(10);
  std::vector<TimedPose> samples;
  for (Eigen::Index k = 0; k < zeta.rows(); ++k) {
    samples.push_back(
        {0.1 * static_cast<double>(k), {zeta.row(k).transpose(), Eigen::Quaterniond::Identity()}});
  }
  const Pose target = {zeta.row(zeta.rows() - 1).transpose(), Eigen::Quaterniond::Identity()};
  SessionParams params;
  params.planner = "elte";
  params.nodes = static_cast<int>(zeta.rows());
  params.horizon_max = 2.0;
  params.confidence = 0.5;
  params.radius_max = 0.02;
  params.approach_length = 0.2;
  SkillSession session(params, Demonstration(samples, "arm", "hand", target));
  Times times;
  for (int i = 0; i < kRepetitions; ++i) {
    session.reset();
    for (Eigen::Index frozen = 2; frozen < zeta.rows(); ++frozen) {
      prf_core::TargetForecast forecast;
      forecast.stamp = stamp;
      forecast.status = prf_core::TargetStatus::kTracking;
      for (int n = 0; n <= 40; ++n) {
        const double horizon = 0.05 * n;
        prf_core::TargetPrediction prediction;
        prediction.horizon = prf_core::from_seconds(horizon);
        prediction.target.pose = target;
        prediction.target.pose.position.y() +=
            0.03 * std::sin(3.0 * horizon + 0.2 * static_cast<double>(frozen));
        const Eigen::Vector3d deviation =
            Eigen::Vector3d(1.0, 1.2, 0.7) * (1e-4 + 0.1 * horizon * horizon);
        prediction.covariance.topLeftCorner<3, 3>().diagonal() = deviation.cwiseAbs2();
        forecast.predictions.push_back(prediction);
      }
      const double to_go = 0.1 * static_cast<double>(zeta.rows() - frozen);
      const Progress progress{
          stamp + std::chrono::milliseconds(50), stamp, frozen, prf_core::from_seconds(to_go), {}};
      times.add([&] { (void)session.plan(progress, &forecast); });
    }
  }
  return times.row("elte, node's whole plan", 0.0);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw std::invalid_argument("usage: elte_benchmark_core recorded_requests.json");
  const auto recorded = nlohmann::json::parse(std::ifstream(argv[1]));
  nlohmann::json rows = nlohmann::json::array();
  for (const Eigen::Index nodes : {50, 100, 200, 1000, 10000}) {
    for (const double radius : {0.0, 0.02}) end_point(nodes, radius, rows);
  }
  rows.push_back(obstacle());
  node_problems(recorded, rows);
  rows.push_back(whole_plan(recorded));
  std::cout << rows.dump(1) << "\n";
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "elte_benchmark_core: %s\n", error.what());
  return 2;
}
