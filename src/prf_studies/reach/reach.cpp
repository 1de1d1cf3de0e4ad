// SPDX-License-Identifier: BSD-3-Clause
// Says whether an arm can go along the path of a demonstration, and where it cannot; with --place,
// from where around it could.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <prf_core/require.hpp>
#include <prf_robots/robot.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "path_reach.hpp"

namespace prf_studies {
namespace {

constexpr int kNotReached = 1;
constexpr int kRefused = 2;

struct Question {
  std::string robot, demonstration;
  std::vector<double> shift{0.0, 0.0, 0.0};
  int draws = 40;
  bool place = false;
  std::string out;
};

std::string shown(const arm_kinematics::JointVector& q) {
  std::string text;
  char number[32];
  for (const double value : q) {
    std::snprintf(number, sizeof(number), "%s%.3f", text.empty() ? "" : ", ", value);
    text += number;
  }
  return "[" + text + "]";
}

Eigen::Isometry3d target_from(const elte_planner::Demonstration& demonstration,
                              const Eigen::Vector3d& base) {
  return Eigen::Translation3d(-base) * demonstration.target().isometry();
}

void say(const PathReach& found, const std::vector<elte_planner::TimedPose>& path) {
  if (found.begin.size() == 0) {
    std::printf("not reached: its beginning is out of reach\n");
    return;
  }
  if (!found.whole) {
    const Eigen::Vector3d& at = path[found.sample + 1].pose.position;
    std::printf("reached until %.2f of %.2f s; then (%.3f, %.3f, %.3f) m in the base is not\n",
                found.until, path.back().time, at.x(), at.y(), at.z());
  } else {
    std::printf(
        "reached: joints at most %.0f %% of their speed, %.2f from a limit, least singular value "
        "%.3f\n",
        100.0 * found.speed_share, found.margin, found.singular_value);
  }
  std::printf("joints at the beginning, for `ready`: %s\n", shown(found.begin).c_str());
}

// The demonstration as this arm would have shown it. Throws std::invalid_argument.
void write(const Question& question, const prf_robots::Robot& robot,
           const elte_planner::Demonstration& demonstration,
           const std::vector<elte_planner::TimedPose>& path) {
  std::ostringstream command;
  command << "rosrun prf_studies reach " << question.robot << " "
          << std::filesystem::path(question.demonstration).filename().string() << " --base";
  for (const double part : question.shift) command << " " << part;
  command << " --out OUT";
  const Eigen::Vector3d base(question.shift[0], question.shift[1], question.shift[2]);
  elte_planner::save_demonstration({path,
                                    robot.base_link,
                                    robot.tip_link,
                                    prf_core::pose_from(target_from(demonstration, base)),
                                    {{"made by", command.str()}}},
                                   question.out);
}

// Displacements of the base from where it is now, nearest first.
std::vector<Eigen::Vector3d> places() {
  std::vector<Eigen::Vector3d> result;
  constexpr double kStep = 0.1;  // m
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) {
      for (int z = -3; z <= 3; ++z) result.emplace_back(kStep * x, kStep * y, kStep * z);
    }
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.norm() < b.norm() - 1e-9; });
  return result;
}

int answer(const Question& question) {
  const auto robot = prf_robots::load_robot(prf_robots::robot_folder(question.robot));
  const auto demonstration = elte_planner::load_demonstration(question.demonstration);
  prf_core::require(question.draws >= 1 && question.draws <= 1000, "--draws", question.draws,
                    "within [1, 1000]");
  const Eigen::Vector3d base(question.shift[0], question.shift[1], question.shift[2]);
  const auto path = placed_at(demonstration, target_from(demonstration, base));
  const PathReach found = path_reach(*robot.kinematics, path, question.draws);
  say(found, path);
  if (!question.out.empty()) write(question, robot, demonstration, path);
  if (found.whole || !question.place) return found.whole ? 0 : kNotReached;
  for (const Eigen::Vector3d& place : places()) {
    const auto there = placed_at(demonstration, target_from(demonstration, base + place));
    const PathReach from_there = path_reach(*robot.kinematics, there, question.draws);
    if (!from_there.whole) continue;
    std::printf("with the base displaced by (%.1f, %.1f, %.1f) m: ", place.x(), place.y(),
                place.z());
    say(from_there, there);
    return kNotReached;
  }
  std::printf("nor with the base displaced by up to 0.3 m in x, y and z\n");
  return kNotReached;
}

}  // namespace
}  // namespace prf_studies

int main(int argc, char** argv) {
  CLI::App app{
      "Whether an arm can go along the path of a demonstration (exit code 0), or where not (1). "
      "The "
      "target is where it was demonstrated, the arm's base in the place of the one that showed "
      "it."};
  prf_studies::Question question;
  app.add_option("robot", question.robot, "one of prf_robots, or the path of a folder")->required();
  app.add_option("demonstration", question.demonstration, "CSV file")->required();
  app.add_option("--base", question.shift, "where the base stands instead, x y z in m")
      ->expected(3);
  app.add_option("--draws", question.draws, "ways of standing that are tried")
      ->capture_default_str();
  app.add_option("--out", question.out, "writes the demonstration as this arm's, for its planner");
  app.add_flag("--place", question.place, "if not: looks for the nearest place of the base");
  try {
    app.parse(argc, argv);
    return prf_studies::answer(question);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : prf_studies::kRefused;
  } catch (const std::exception& error) {
    std::cerr << "reach: " << error.what() << "\n";
    return prf_studies::kRefused;
  }
}
