// SPDX-License-Identifier: BSD-3-Clause
// Inverse kinematics of robots on random poses that are reachable within limits: the robot's own
// kinematics, the chain of its URDF, and KDL's LMA and NR_JL, all on the same poses in one run.
// Far: every solver starts from the ready posture. Near: from joints at most kNear from some that
// give the pose, as a controller does. Times are processor times of the thread.
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <arm_kinematics/chain_kinematics.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "prf_robots/robot.hpp"

namespace prf_robots {
namespace {

using arm_kinematics::ArmKinematics;
using arm_kinematics::JointLimits;

constexpr double kPrecision = 1e-6;  // m, rad; asked of KDL, and that each result must have
constexpr int kMaxIterations = 500;
constexpr double kNear = 0.05;  // rad or m of every joint

struct Question {
  Eigen::Isometry3d pose;
  JointVector seed;
};

using Solver = std::function<std::optional<JointVector>(const Question& question)>;

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

// Whole turns into the limits, as a caller would take them: KDL's LMA knows no limits.
JointVector in_turn(JointVector q, const JointLimits& limits) {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (!std::isfinite(limits.lower[i]) || std::abs(q[i]) > 1e6) continue;
    while (q[i] < limits.lower[i]) q[i] += 2.0 * M_PI;
    while (q[i] > limits.upper[i]) q[i] -= 2.0 * M_PI;
  }
  return q;
}

void measure(const std::string& name, const ArmKinematics& arm,
             const std::vector<Question>& questions, const Solver& solve) {
  std::vector<double> times;
  int met = 0;
  int solved = 0;
  for (const Question& question : questions) {
    const double begin = thread_us();
    const auto found = solve(question);
    times.push_back(thread_us() - begin);
    if (!found || !found->allFinite()) continue;
    const JointVector q = in_turn(*found, arm.limits());
    const auto error = arm_kinematics::error_between(arm.forward(q), question.pose, arm.task());
    if (!(error.position <= kPrecision && error.orientation <= kPrecision)) continue;
    ++met;
    const bool inside = (q.array() >= arm.limits().lower.array()).all() &&
                        (q.array() <= arm.limits().upper.array()).all();
    if (inside) ++solved;
  }
  std::sort(times.begin(), times.end());
  const auto count = static_cast<double>(times.size());
  double sum = 0.0;
  for (double time : times) sum += time;
  std::printf("  %-30s%9.2f%9.2f%11.1f%10.1f%10.1f\n", name.c_str(), 100.0 * solved / count,
              100.0 * met / count, times[times.size() / 2], sum / count,
              times[static_cast<std::size_t>(0.99 * (count - 1.0))]);
}

KDL::JntArray to_kdl(const JointVector& q) {
  KDL::JntArray joints(static_cast<unsigned>(q.size()));
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

Solver solver_of(KDL::ChainIkSolverPos& solver) {
  return [&solver](const Question& question) -> std::optional<JointVector> {
    KDL::JntArray q(static_cast<unsigned>(question.seed.size()));
    if (solver.CartToJnt(to_kdl(question.seed), to_kdl(question.pose), q) < 0) return std::nullopt;
    return JointVector(q.data);
  };
}

Solver solver_of(const ArmKinematics& arm) {
  return [&arm](const Question& question) -> std::optional<JointVector> {
    const auto result = arm.inverse(question.pose, question.seed, {1});
    if (!result.solved) return std::nullopt;
    return result.q;
  };
}

KDL::Chain kdl_chain(const Robot& robot) {
  KDL::Tree tree;
  KDL::Chain chain;
  if (!kdl_parser::treeFromString(robot.urdf, tree) ||
      !tree.getChain(robot.base_link, robot.tip_link, chain)) {
    throw std::invalid_argument(robot.folder + ": KDL cannot read robot.urdf");
  }
  return chain;
}

// The same poses, far in the first list and near in the second.
std::pair<std::vector<Question>, std::vector<Question>> draw(const Robot& robot, int poses,
                                                             unsigned seed) {
  std::mt19937 generator(seed);
  const JointLimits& limits = robot.kinematics->limits();
  const JointVector lower = limits.lower.cwiseMax(-M_PI);
  const JointVector upper = limits.upper.cwiseMin((lower.array() + 2.0 * M_PI).matrix());
  std::uniform_real_distribution<> share(0.0, 1.0);
  std::pair<std::vector<Question>, std::vector<Question>> questions;
  for (int i = 0; i < poses; ++i) {
    JointVector q = lower;
    for (Eigen::Index k = 0; k < q.size(); ++k) q[k] += share(generator) * (upper[k] - lower[k]);
    JointVector near = q;
    for (Eigen::Index k = 0; k < q.size(); ++k) near[k] += kNear * (2.0 * share(generator) - 1.0);
    const Eigen::Isometry3d pose = robot.kinematics->forward(q);
    questions.first.push_back({pose, robot.ready});
    questions.second.push_back({pose, near.cwiseMax(limits.lower).cwiseMin(limits.upper)});
  }
  return questions;
}

void run(const std::string& name, int poses, unsigned seed) {
  const Robot robot = load_robot(robot_folder(name));
  const ArmKinematics& own = *robot.kinematics;
  const arm_kinematics::ChainKinematics chain(
      arm_kinematics::chain_from_urdf(robot.urdf, robot.base_link, robot.tip_link));
  const KDL::Chain kdl = kdl_chain(robot);
  const auto kdl_limit = [](const JointVector& limit) {
    return to_kdl(limit.cwiseMax(-2.0 * M_PI).cwiseMin(2.0 * M_PI));
  };
  KDL::ChainIkSolverPos_LMA lma(kdl, Eigen::Matrix<double, 6, 1>::Ones(), kPrecision,
                                kMaxIterations);
  KDL::ChainFkSolverPos_recursive fk(kdl);
  KDL::ChainIkSolverVel_pinv velocity(kdl);
  KDL::ChainIkSolverPos_NR_JL nr_jl(kdl, kdl_limit(own.limits().lower),
                                    kdl_limit(own.limits().upper), fk, velocity, kMaxIterations,
                                    kPrecision);

  const auto [far, near] = draw(robot, poses, seed);
  const bool has_closed_form =
      dynamic_cast<const arm_kinematics::ChainKinematics*>(&own) == nullptr;
  std::printf("%s, %d joints\n", name.c_str(), own.joint_count());
  for (const auto* questions : {&far, &near}) {
    const std::string prefix = questions == &far ? "far: " : "near: ";
    if (has_closed_form) measure(prefix + "closed form", own, *questions, solver_of(own));
    measure(prefix + "chain", own, *questions, solver_of(chain));
    measure(prefix + "KDL LMA", own, *questions, solver_of(lma));
    measure(prefix + "KDL NR_JL", own, *questions, solver_of(nr_jl));
  }
}

}  // namespace
}  // namespace prf_robots

int main(int argc, char** argv) {
  int poses = 10000;
  unsigned seed = 1;
  std::vector<std::string> robots;
  CLI::App app("Times inverse kinematics on the same random reachable poses of each robot.");
  app.add_option("robots", robots, "names or folders; none: every robot of prf_robots");
  app.add_option("--poses", poses)->check(CLI::Range(1, 1000000))->capture_default_str();
  app.add_option("--seed", seed)->check(CLI::Range(0, 2147483647))->capture_default_str();
  try {
    app.parse(argc, argv);
    if (robots.empty()) robots = prf_robots::robot_names();
    std::printf("  %-30s%9s%9s%11s%10s%10s\n", "solver", "solved %", "met %", "median us",
                "mean us", "p99 us");
    for (const std::string& robot : robots) prf_robots::run(robot, poses, seed);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << "kinematics_benchmark: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
