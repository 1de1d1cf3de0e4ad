// SPDX-License-Identifier: BSD-3-Clause
// Inverse kinematics of the arm on random reachable poses: the closed form and KDL's two iterative
// solvers, all on the same poses in one run. Far: every solver starts from the arm ready in front.
// Near: from joints at most kNear from some that give the pose, as a controller does. Times are
// processor times of the thread.
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "benchmark_table.hpp"
#include "random_joints.hpp"

namespace jaco_kinematics {
namespace {

constexpr double kPrecision = 1e-6;  // m, rad; asked of KDL, and that each result must have
constexpr int kMaxIterations = 500;
constexpr double kNear = 0.05;  // rad of every joint

struct Task {
  Eigen::Isometry3d pose;
  JointVector seed;
};

using Solver = std::function<std::optional<JointVector>(const Task& task)>;

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

JointVector ready() {
  return (JointVector() << 0.98, 2.32, 1.29, 1.39, -0.84, 2.23, -1.48).finished();
}

KDL::JntArray to_kdl(const JointVector& q) {
  KDL::JntArray joints(7);
  joints.data = q;
  return joints;
}

KDL::Frame to_kdl(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d r = pose.linear();
  const Eigen::Vector3d p = pose.translation();
  return {KDL::Rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1),
                        r(2, 2)),
          KDL::Vector(p.x(), p.y(), p.z())};
}

// Joints 2, 4 and 6 in [0, 2 pi), as their limits are given.
JointVector in_turn(JointVector q) {
  for (int i : {1, 3, 5}) q[i] = std::fmod(std::fmod(q[i], 2 * M_PI) + 2 * M_PI, 2 * M_PI);
  return q;
}

bool meets(const JointVector& q, const Eigen::Isometry3d& pose, Row& row) {
  const Eigen::Isometry3d reached = forward(q);
  const double position = (reached.translation() - pose.translation()).norm();
  const double orientation = (reached.linear() - pose.linear()).norm() / std::sqrt(2.0);
  if (!(position <= kPrecision && orientation <= kPrecision)) return false;
  ++row.converged;
  if (!inside_limits(q)) return false;
  row.position_error = std::max(row.position_error, position);
  row.orientation_error = std::max(row.orientation_error, orientation);
  return true;
}

Row measure(const std::string& name, const std::vector<Task>& tasks, const Solver& solve) {
  Row row{name};
  for (const Task& task : tasks) {
    const double begin = thread_us();
    const auto q = solve(task);
    row.times.push_back(thread_us() - begin);
    if (q && meets(in_turn(*q), task.pose, row)) ++row.solved;
    row.progress(tasks.size());
  }
  return row;
}

std::optional<JointVector> solution(const IkResult& result) {
  return result.status == IkStatus::kSolved ? std::optional<JointVector>(result.q) : std::nullopt;
}

Solver solver_of(KDL::ChainIkSolverPos& solver) {
  return [&solver](const Task& task) {
    KDL::JntArray q(7);
    const bool solved = solver.CartToJnt(to_kdl(task.seed), to_kdl(task.pose), q) >= 0;
    return solved ? std::optional<JointVector>(q.data) : std::nullopt;
  };
}

KDL::Chain arm_chain(const std::string& urdf) {
  KDL::Tree tree;
  KDL::Chain chain;
  if (!kdl_parser::treeFromFile(urdf, tree) ||
      !tree.getChain("j2s7s300_link_base", "j2s7s300_end_effector", chain)) {
    throw std::invalid_argument(urdf + " cannot be read, or has no arm");
  }
  return chain;
}

// The same poses, far in the first list and near in the second.
std::pair<std::vector<Task>, std::vector<Task>> draw_tasks(const BenchmarkParams& params) {
  std::mt19937 generator(params.seed);
  std::uniform_real_distribution<> offset(-kNear, kNear);
  std::pair<std::vector<Task>, std::vector<Task>> tasks;
  for (int i = 0; i < params.poses; ++i) {
    const JointVector q = random_joints(&generator);
    const JointVector seed = q + JointVector::NullaryExpr([&] { return offset(generator); });
    const JointLimits& limits = jaco_joint_limits();
    tasks.first.push_back({forward(q), ready()});
    tasks.second.push_back({forward(q), seed.cwiseMax(limits.lower).cwiseMin(limits.upper)});
  }
  return tasks;
}

std::vector<Row> run(const BenchmarkParams& params) {
  const KDL::Chain chain = arm_chain(params.urdf);
  const JointLimits& limits = jaco_joint_limits();
  KDL::ChainIkSolverPos_LMA lma(chain, Eigen::Matrix<double, 6, 1>::Ones(), kPrecision,
                                kMaxIterations);
  KDL::ChainFkSolverPos_recursive fk(chain);
  KDL::ChainIkSolverVel_pinv velocity(chain);
  KDL::ChainIkSolverPos_NR_JL nr_jl(chain,
                                    to_kdl(limits.lower.cwiseMax(JointVector::Constant(-2 * M_PI))),
                                    to_kdl(limits.upper.cwiseMin(JointVector::Constant(2 * M_PI))),
                                    fk, velocity, kMaxIterations, kPrecision);
  const auto any = [](const Task& task) { return solution(any_inverse(task.pose)); };
  const auto nearest = [](const Task& task) { return solution(inverse(task.pose, task.seed)); };

  const auto [far, near] = draw_tasks(params);
  std::vector<Row> rows;
  rows.push_back(measure("far: closed form, any solution", far, any));
  rows.push_back(measure("far: closed form, nearest to the seed", far, nearest));
  rows.push_back(measure("far: KDL LMA", far, solver_of(lma)));
  rows.push_back(measure("far: KDL NR_JL", far, solver_of(nr_jl)));
  rows.push_back(measure("near: closed form, nearest to the seed", near, nearest));
  rows.push_back(measure("near: KDL LMA", near, solver_of(lma)));
  rows.push_back(measure("near: KDL NR_JL", near, solver_of(nr_jl)));
  return rows;
}

}  // namespace
}  // namespace jaco_kinematics

int main(int argc, char** argv) {
  using namespace jaco_kinematics;
  BenchmarkParams params;
  CLI::App app("Times the closed form and KDL's LMA and NR_JL on the same random reachable poses.");
  app.add_option("--poses", params.poses)->check(CLI::Range(1, 1000000))->capture_default_str();
  app.add_option("--seed", params.seed)->check(CLI::Range(0, 2147483647))->capture_default_str();
  app.add_option("--urdf", params.urdf)->capture_default_str();
  app.add_option("--json", params.json, "also write the figures to this file");
  try {
    app.parse(argc, argv);
    const std::vector<Row> rows = run(params);
    print_table(rows);
    if (!params.json.empty()) write_json(rows, params);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << "ik_benchmark: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
