// SPDX-License-Identifier: BSD-3-Clause
// Compares how the simulated robot moves on the platform with motion capture of the real one.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "motion_reference.hpp"
#include "platform_sim/platform_motion.hpp"
#include "platform_sim/put_robot.hpp"
#include "v60_gait/gravity.hpp"

namespace {

using namespace motion_capture;

constexpr double kWarmUp = 6.0;        // s
constexpr char kRobot[] = "jaco_v60";  // that was captured
constexpr double kTolerance = 0.3;
constexpr double kPi = 3.14159265358979323846;
constexpr double kOtherWindow = 8.0;  // s, of a condition that was not captured

struct Study {
  std::vector<MotionCondition> conditions;
  long seeds = 3;
  double duration = 40.0;  // s
  bool arm_moves = false;
  bool falls = false;
  double push = 0.0;     // N
  double payload = 0.0;  // kg
  std::string captures, json;
};

struct MotionResult {
  MotionCondition condition;
  FigureRow figures{};
  std::size_t windows = 0;
  double slip = 0.0;  // mm/s
  double cadence = 0.0;
  Eigen::Matrix3Xd lines;  // mm
  std::vector<std::string> falls;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

platform_sim::WorldParams world_params(const MotionCondition& condition, long seed) {
  platform_sim::WorldParams config;
  config.motion = condition.motion;
  config.gait = condition.gait;
  config.seed = static_cast<std::uint64_t>(seed);
  platform_sim::put_robot(kRobot, &config);
  return config;
}

// Swings shoulder and elbow through 0.5 rad at up to 0.6 rad/s, the limit of the arm.
void swing_arm(const platform_sim::ArmVector& start, platform_sim::World& world) {
  constexpr double kSwing = 0.25, kRate = 2.4;  // rad, rad/s
  platform_sim::ArmVector positions = start;
  platform_sim::ArmVector velocities = platform_sim::ArmVector::Zero(start.size());
  for (const Eigen::Index joint : {0, 1, 3}) {
    positions[joint] += kSwing * std::sin(kRate * world.time());
    velocities[joint] = kSwing * kRate * std::cos(kRate * world.time());
  }
  world.command_arm(positions, velocities);
}

void disturb(const Study& study, platform_sim::World& world) {
  constexpr double kPeriod = 3.0, kLength = 0.2;  // s
  constexpr double kTurn = 2.4;                   // rad, from push to push
  const std::string& hand = world.robot().hand;
  if (study.payload > 0.0) world.push(hand, {0.0, 0.0, -v60_gait::kGravity * study.payload});
  const double pushes = std::floor(world.time() / kPeriod);
  if (study.push == 0.0 || pushes < 1.0 || world.time() - kPeriod * pushes > kLength) return;
  const Eigen::Vector3d side(std::cos(kTurn * pushes), std::sin(kTurn * pushes), 0.0);
  world.push(std::fmod(pushes, 2.0) == 0.0 ? hand : world.base_link(), study.push * side);
}

// Returns whether the robot is still on its feet at the end.
bool observe(const Study& study, const platform_sim::ArmVector& start, double duration,
             platform_sim::World& world, MotionObserver& observer) {
  const double end = world.time() + duration;
  while (world.time() < end - 0.5 * platform_sim::World::kTimeStep && !world.fallen()) {
    if (study.arm_moves) swing_arm(start, world);
    observer.step(world, [&](platform_sim::World& now) { disturb(study, now); });
  }
  return !world.fallen();
}

std::vector<double> line_rates(const MotionCondition& condition, double cadence) {
  std::vector<double> rates = condition.rates;
  if (cadence > 0.0) rates.insert(rates.end(), {2.0 * kPi * cadence, 4.0 * kPi * cadence});
  return rates;
}

void summarise(const std::vector<std::vector<MotionPiece>>& windows, MotionResult& result) {
  std::vector<FigureRow> rows;
  for (const auto& pieces : windows) rows.push_back(figure_row(measure_motion(pieces)));
  result.windows = rows.size();
  if (rows.empty()) return;
  for (std::size_t i = 0; i < kFigureCount; ++i) {
    std::vector<double> values;
    for (const FigureRow& row : rows) values.push_back(row[i]);
    result.figures[i] = median(values);
  }
  result.cadence = result.figures[kFigureCount - 3];
  const std::vector<double> rates = line_rates(result.condition, result.cadence);
  result.lines = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(rates.size()) + 1);
  for (const auto& pieces : windows) result.lines += 1000.0 * tag_lines(pieces, rates);
  result.lines /= static_cast<double>(windows.size());
}

MotionResult simulate(const Study& study, const MotionCondition& condition,
                      const std::string& urdf) {
  MotionResult result;
  result.condition = condition;
  std::vector<std::vector<MotionPiece>> windows;
  double seconds = 0.0;
  for (long seed = 1; seed <= study.seeds; ++seed) {
    std::fprintf(stderr, "%s: seed %ld of %ld   \r", condition.name.c_str(), seed, study.seeds);
    const platform_sim::WorldParams config = world_params(condition, seed);
    platform_sim::World world(urdf, config);
    MotionObserver observer;
    bool stands = observe(study, config.arm_start, kWarmUp, world, observer);
    const double slip_before = observer.slip();
    const std::size_t first = observer.samples().size();
    if (stands) stands = observe(study, config.arm_start, study.duration, world, observer);
    if (!stands) {
      std::ostringstream fall;
      fall << "seed " << seed << " at " << world.time() << " s";
      result.falls.push_back(fall.str());
    }
    result.slip += 1000.0 * (observer.slip() - slip_before);
    seconds += 0.01 * static_cast<double>(observer.samples().size() - first);
    const auto length = static_cast<std::size_t>(std::lround(100.0 * condition.window)) + 1;
    if (study.falls) continue;
    for (std::size_t at = first; at + length <= observer.samples().size(); at += length) {
      windows.push_back(window_of(condition, observer.samples(), at));
    }
  }
  std::fprintf(stderr, "%40s\r", "");
  result.slip /= std::max(seconds, 0.01);
  summarise(windows, result);
  return result;
}

MotionResult evaluate_capture(const Study& study, const MotionCondition& condition) {
  MotionResult result;
  result.condition = condition;
  std::vector<MotionPiece> pieces = read_capture(study.captures + "/" + condition.name + ".csv");
  if (condition.without_drift) remove_drift(pieces);
  summarise({pieces}, result);
  return result;
}

bool agrees(std::size_t figure, double value, double measured) {
  return std::abs(value - measured) <= std::max(kTolerance * measured, kFigureKinds[figure].slack);
}

void print(const MotionResult& result) {
  const MotionCondition& condition = result.condition;
  std::printf("\n%s: motion %s, gait %s, median of %zu windows of %.1f s%s\n",
              condition.name.c_str(), condition.motion.c_str(), condition.gait.c_str(),
              result.windows, condition.window,
              condition.without_drift ? ", without linear drift" : "");
  for (const std::string& fall : result.falls) std::printf("  FELL: %s\n", fall.c_str());
  if (result.windows == 0) return;
  std::printf("  %-20s %10s %10s %7s  within 30 %%\n", "peak to peak", "here", "real", "ratio");
  for (std::size_t i = 0; i < kFigureCount; ++i) {
    const FigureKind& kind = kFigureKinds[i];
    std::printf("  %-20s %10.*f", kind.key, kind.digits, result.figures[i]);
    if (condition.measured) {
      const double measured = (*condition.measured)[i];
      std::printf(" %10.*f", kind.digits, measured);
      if (measured > 0.0) {
        const bool close = std::abs(result.figures[i] - measured) <= kTolerance * measured;
        std::printf(" %7.2f  %s", result.figures[i] / measured,
                    close                                    ? "yes"
                    : agrees(i, result.figures[i], measured) ? "small"
                                                             : "NO");
      }
    }
    std::printf("\n");
  }
  const std::vector<double> rates = line_rates(condition, result.cadence);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Eigen::Vector3d line = result.lines.col(static_cast<Eigen::Index>(i));
    std::printf("  tag at %.2f Hz: %.1f %.1f %.1f mm\n", rates[i] / (2.0 * kPi), line.x(), line.y(),
                line.z());
  }
  const Eigen::Vector3d rest = result.lines.col(result.lines.cols() - 1);
  std::printf("  rest: %.1f %.1f %.1f mm (standard deviation); feet slide %.1f mm/s\n", rest.x(),
              rest.y(), rest.z(), result.slip);
}

nlohmann::ordered_json to_json(const MotionResult& result) {
  const MotionCondition& condition = result.condition;
  nlohmann::ordered_json json{
      {"name", condition.name},    {"motion", condition.motion},
      {"gait", condition.gait},    {"window_s", condition.window},
      {"windows", result.windows}, {"falls", result.falls.size()},
      {"slip_mm_s", result.slip},  {"figures", nlohmann::ordered_json::object()}};
  for (std::size_t i = 0; i < kFigureCount && result.windows > 0; ++i) {
    nlohmann::ordered_json& figure = json["figures"][kFigureKinds[i].key];
    figure["here"] = result.figures[i];
    if (!condition.measured) continue;
    const double measured = (*condition.measured)[i];
    figure["real"] = measured;
    figure["agrees"] = agrees(i, result.figures[i], measured);
  }
  return json;
}

MotionCondition condition_of(const std::string& motion, const std::string& gait) {
  for (const MotionCondition& condition : captured_conditions()) {
    if (condition.motion == motion && condition.gait == gait) return condition;
  }
  MotionCondition condition;
  condition.name = motion + "_" + gait;
  condition.motion = motion;
  condition.gait = gait;
  condition.window = kOtherWindow;
  return condition;
}

// The options of the command line; throws CLI::ParseError or std::invalid_argument.
Study read_options(CLI::App& app, int argc, char** argv) {
  Study study;
  std::string motion, gait, arm = "still";
  app.add_option("--motion", motion, "of the platform, one condition only [light, --falls: heavy]");
  app.add_option("--gait", gait, "one condition only [stand, --falls: step]");
  auto* seeds = app.add_option("--seeds", study.seeds, "simulations per condition")
                    ->check(CLI::Range(1L, 10000L))
                    ->capture_default_str();
  auto* falls = app.add_option("--falls", study.seeds, "how many of so many seeds fall")
                    ->check(CLI::Range(1L, 10000L))
                    ->excludes(seeds);
  auto* duration = app.add_option("--duration", study.duration, "s, of each [40, --falls: 60]")
                       ->check(CLI::Range(10.0, 3600.0));
  app.add_option("--arm", arm, "moving: its joints swing as fast as they may")
      ->check(CLI::IsMember({"still", "moving"}))
      ->capture_default_str();
  app.add_option("--push", study.push,
                 "N, for 0.2 s every 3 s, at hand and body in turn, to all sides")
      ->check(CLI::Range(0.0, 1000.0))
      ->needs(falls);
  app.add_option("--payload", study.payload, "kg, of which the hand carries the weight")
      ->check(CLI::Range(0.0, 10.0))
      ->needs(falls);
  app.add_option("--mocap", study.captures,
                 "folder of captures (CSV) to evaluate instead of simulating");
  app.add_option("--json", study.json, "file that the figures are written to");
  app.parse(argc, argv);

  study.falls = !falls->empty();
  if (study.falls && duration->empty()) study.duration = 60.0;
  study.arm_moves = arm == "moving";
  if (!study.falls && motion.empty() && gait.empty()) {
    study.conditions = captured_conditions();
    return study;
  }
  if (motion.empty()) motion = study.falls ? "heavy" : "light";
  if (gait.empty()) gait = study.falls ? "step" : "stand";
  study.conditions = {condition_of(motion, gait)};
  world_params(study.conditions[0], 1).validate();
  return study;
}

// Returns the number of falls.
std::size_t run(const Study& study) {
  std::ofstream file;
  if (!study.json.empty()) {
    file.open(study.json);
    if (!file)
      throw std::invalid_argument(
          "--json = " + study.json +
          " cannot be written: is its folder there, and may this user write to it?");
  }
  const std::string urdf =
      study.captures.empty() ? prf_robots::load_robot(prf_robots::robot_folder(kRobot)).urdf : "";
  nlohmann::ordered_json json{{"conditions", nlohmann::ordered_json::array()}};
  std::size_t falls = 0;
  for (const MotionCondition& condition : study.conditions) {
    const MotionResult result = study.captures.empty() ? simulate(study, condition, urdf)
                                                       : evaluate_capture(study, condition);
    print(result);
    if (study.falls) {
      std::printf("  %zu of %ld seeds fell within %.0f s; feet slide %.1f mm/s\n",
                  result.falls.size(), study.seeds, kWarmUp + study.duration, result.slip);
    }
    std::fflush(stdout);
    json["conditions"].push_back(to_json(result));
    falls += result.falls.size();
  }
  if (file.is_open()) file << json.dump(1) << "\n";
  return falls;
}

int command(int argc, char** argv) {
  CLI::App app{
      "Compares how the simulated robot moves on the platform with motion capture of the real "
      "one."};
  try {
    return run(read_options(app, argc, argv)) == 0 ? 0 : 1;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return command(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "validate_motion: " << error.what() << "\n";
    return 2;
  }
}
