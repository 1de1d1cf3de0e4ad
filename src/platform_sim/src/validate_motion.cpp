// SPDX-License-Identifier: BSD-3-Clause
// Compares how the simulated robot moves on the platform with motion capture of the real one.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "gravity.hpp"
#include "motion_reference.hpp"
#include "options.hpp"
#include "platform_sim/platform_motion.hpp"
#include "robot_files.hpp"

namespace {

using namespace platform_sim;

constexpr char kUsage[] =
    "usage: validate_motion [--motion M] [--gait G] [--seeds 3] [--duration 40] [--arm still]\n"
    "                       [--json FILE]      figures beside those of the real robot\n"
    "       validate_motion --falls 20 [--motion heavy] [--gait step] [--duration 60]\n"
    "                       [--arm still] [--push 0] [--payload 0]   how many of so many seeds "
    "fall\n"
    "       validate_motion --mocap DIR [--json FILE]   figures of CSV files of captures\n"
    "  --arm: still, or moving (its joints swing as fast as they may)\n"
    "  --push: N, for 0.2 s every 3 s, at hand and body in turn, to all sides\n"
    "  --payload: kg, of which the hand carries the weight\n";
constexpr double kWarmUp = 6.0;  // s
constexpr double kTolerance = 0.3;
constexpr double kPi = 3.14159265358979323846;
constexpr double kUnseenWindow = 8.0;  // s, of a condition that was not captured

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

struct Outcome {
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

WorldConfig world_config(const MotionCondition& condition, long seed) {
  WorldConfig config;
  config.motion = condition.motion;
  config.gait = condition.gait;
  config.seed = static_cast<std::uint64_t>(seed);
  config.arm_start = configured_arm_start();
  return config;
}

// Swings shoulder and elbow through 0.5 rad at up to 0.6 rad/s, the limit of the arm.
void swing_arm(const ArmVector& start, World& world) {
  constexpr double kSwing = 0.25, kRate = 2.4;  // rad, rad/s
  ArmVector positions = start;
  ArmVector velocities = ArmVector::Zero();
  for (const Eigen::Index joint : {0, 1, 3}) {
    positions[joint] += kSwing * std::sin(kRate * world.time());
    velocities[joint] = kSwing * kRate * std::cos(kRate * world.time());
  }
  world.command_arm(positions, velocities);
}

void disturb(const Study& study, World& world) {
  constexpr double kPeriod = 3.0, kLength = 0.2;  // s
  constexpr double kTurn = 2.4;                   // rad, from push to push
  const char* const hand = "j2s7s300_end_effector";
  if (study.payload > 0.0) world.push(hand, {0.0, 0.0, -kGravity * study.payload});
  const double pushes = std::floor(world.time() / kPeriod);
  if (study.push == 0.0 || pushes < 1.0 || world.time() - kPeriod * pushes > kLength) return;
  const Eigen::Vector3d side(std::cos(kTurn * pushes), std::sin(kTurn * pushes), 0.0);
  world.push(std::fmod(pushes, 2.0) == 0.0 ? hand : "base_link", study.push * side);
}

// Returns whether the robot is still on its feet at the end.
bool observe(const Study& study, const ArmVector& start, double duration, World& world,
             MotionObserver& observer) {
  const double end = world.time() + duration;
  while (world.time() < end - 0.5 * World::kTimeStep && !world.fallen()) {
    if (study.arm_moves) swing_arm(start, world);
    observer.step(world, [&](World& now) { disturb(study, now); });
  }
  return !world.fallen();
}

std::vector<double> line_rates(const MotionCondition& condition, double cadence) {
  std::vector<double> rates = condition.rates;
  if (cadence > 0.0) rates.insert(rates.end(), {2.0 * kPi * cadence, 4.0 * kPi * cadence});
  return rates;
}

void summarise(const std::vector<std::vector<MotionPiece>>& windows, Outcome& outcome) {
  std::vector<FigureRow> rows;
  for (const auto& pieces : windows) rows.push_back(figure_row(measure_motion(pieces)));
  outcome.windows = rows.size();
  if (rows.empty()) return;
  for (std::size_t i = 0; i < kFigureCount; ++i) {
    std::vector<double> values;
    for (const FigureRow& row : rows) values.push_back(row[i]);
    outcome.figures[i] = median(values);
  }
  outcome.cadence = outcome.figures[kFigureCount - 3];
  const std::vector<double> rates = line_rates(outcome.condition, outcome.cadence);
  outcome.lines = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(rates.size()) + 1);
  for (const auto& pieces : windows) outcome.lines += 1000.0 * tag_lines(pieces, rates);
  outcome.lines /= static_cast<double>(windows.size());
}

Outcome simulate(const Study& study, const MotionCondition& condition, const std::string& urdf) {
  Outcome outcome;
  outcome.condition = condition;
  std::vector<std::vector<MotionPiece>> windows;
  double seconds = 0.0;
  for (long seed = 1; seed <= study.seeds; ++seed) {
    std::fprintf(stderr, "%s: seed %ld of %ld   \r", condition.name.c_str(), seed, study.seeds);
    const WorldConfig config = world_config(condition, seed);
    World world(urdf, config);
    MotionObserver observer;
    bool stands = observe(study, config.arm_start, kWarmUp, world, observer);
    const double slip_before = observer.slip();
    const std::size_t first = observer.samples().size();
    if (stands) stands = observe(study, config.arm_start, study.duration, world, observer);
    if (!stands) {
      std::ostringstream fall;
      fall << "seed " << seed << " at " << world.time() << " s";
      outcome.falls.push_back(fall.str());
    }
    outcome.slip += 1000.0 * (observer.slip() - slip_before);
    seconds += 0.01 * static_cast<double>(observer.samples().size() - first);
    const auto length = static_cast<std::size_t>(std::lround(100.0 * condition.window)) + 1;
    if (study.falls) continue;
    for (std::size_t at = first; at + length <= observer.samples().size(); at += length) {
      windows.push_back(window_of(condition, observer.samples(), at));
    }
  }
  std::fprintf(stderr, "%40s\r", "");
  outcome.slip /= std::max(seconds, 0.01);
  summarise(windows, outcome);
  return outcome;
}

Outcome evaluate_capture(const Study& study, const MotionCondition& condition) {
  Outcome outcome;
  outcome.condition = condition;
  std::vector<MotionPiece> pieces = read_capture(study.captures + "/" + condition.name + ".csv");
  if (condition.without_drift) remove_drift(pieces);
  summarise({pieces}, outcome);
  return outcome;
}

bool agrees(std::size_t figure, double value, double measured) {
  return std::abs(value - measured) <= std::max(kTolerance * measured, kFigureKinds[figure].slack);
}

void print(const Outcome& outcome) {
  const MotionCondition& condition = outcome.condition;
  std::printf("\n%s: motion %s, gait %s, median of %zu windows of %.1f s%s\n",
              condition.name.c_str(), condition.motion.c_str(), condition.gait.c_str(),
              outcome.windows, condition.window,
              condition.without_drift ? ", without linear drift" : "");
  for (const std::string& fall : outcome.falls) std::printf("  FELL: %s\n", fall.c_str());
  if (outcome.windows == 0) return;
  std::printf("  %-20s %10s %10s %7s  within 30 %%\n", "peak to peak", "here", "real", "ratio");
  for (std::size_t i = 0; i < kFigureCount; ++i) {
    const FigureKind& kind = kFigureKinds[i];
    std::printf("  %-20s %10.*f", kind.key, kind.digits, outcome.figures[i]);
    if (condition.measured) {
      const double measured = (*condition.measured)[i];
      std::printf(" %10.*f", kind.digits, measured);
      if (measured > 0.0) {
        const bool close = std::abs(outcome.figures[i] - measured) <= kTolerance * measured;
        std::printf(" %7.2f  %s", outcome.figures[i] / measured,
                    close                                     ? "yes"
                    : agrees(i, outcome.figures[i], measured) ? "small"
                                                              : "NO");
      }
    }
    std::printf("\n");
  }
  const std::vector<double> rates = line_rates(condition, outcome.cadence);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Eigen::Vector3d line = outcome.lines.col(static_cast<Eigen::Index>(i));
    std::printf("  tag at %.2f Hz: %.1f %.1f %.1f mm\n", rates[i] / (2.0 * kPi), line.x(), line.y(),
                line.z());
  }
  const Eigen::Vector3d rest = outcome.lines.col(outcome.lines.cols() - 1);
  std::printf("  rest: %.1f %.1f %.1f mm (standard deviation); feet slide %.1f mm/s\n", rest.x(),
              rest.y(), rest.z(), outcome.slip);
}

std::string to_json(const Outcome& outcome) {
  std::ostringstream text;
  text << "{\"name\": \"" << outcome.condition.name << "\", \"motion\": \""
       << outcome.condition.motion << "\", \"gait\": \"" << outcome.condition.gait
       << "\", \"window_s\": " << outcome.condition.window << ", \"windows\": " << outcome.windows
       << ", \"falls\": " << outcome.falls.size() << ", \"slip_mm_s\": " << outcome.slip
       << ", \"figures\": {";
  for (std::size_t i = 0; i < kFigureCount && outcome.windows > 0; ++i) {
    text << (i == 0 ? "" : ", ") << "\"" << kFigureKinds[i].key
         << "\": {\"here\": " << outcome.figures[i];
    if (outcome.condition.measured) {
      const double measured = (*outcome.condition.measured)[i];
      text << ", \"real\": " << measured
           << ", \"agrees\": " << (agrees(i, outcome.figures[i], measured) ? "true" : "false");
    }
    text << "}";
  }
  text << "}}";
  return text.str();
}

MotionCondition condition_of(const std::string& motion, const std::string& gait) {
  for (const MotionCondition& condition : captured_conditions()) {
    if (condition.motion == motion && condition.gait == gait) return condition;
  }
  MotionCondition condition;
  condition.name = motion + "_" + gait;
  condition.motion = motion;
  condition.gait = gait;
  condition.window = kUnseenWindow;
  return condition;
}

Study read_options(int argc, char** argv) {
  Options options(argc, argv);
  Study study;
  study.falls = options.has("falls");
  study.seeds = options.integer("seeds", 3);
  if (study.falls) study.seeds = options.integer("falls", 20);
  if (study.seeds < 1 || study.seeds > 10000) {
    throw std::invalid_argument("number of seeds must be from 1 to 10000");
  }
  study.duration = options.number("duration", study.falls ? 60.0 : 40.0);
  if (study.duration < 10.0 || study.duration > 3600.0) {
    throw std::invalid_argument("--duration must be from 10 to 3600 s");
  }
  const std::string arm = options.text("arm", "still");
  study.arm_moves = arm == "moving";
  if (!study.arm_moves && arm != "still") {
    throw std::invalid_argument("--arm = '" + arm + "', must be still or moving");
  }
  const bool all = !study.falls && !options.has("motion") && !options.has("gait");
  const std::string motion = options.text("motion", study.falls ? "heavy" : "light");
  const std::string gait = options.text("gait", study.falls ? "step" : "stand");
  study.push = options.number("push", 0.0);
  study.payload = options.number("payload", 0.0);
  if (!study.falls && (study.push != 0.0 || study.payload != 0.0)) {
    throw std::invalid_argument("--push and --payload go with --falls");
  }
  if (!(study.push >= 0.0 && study.push <= 1000.0)) {
    throw std::invalid_argument("--push must be from 0 to 1000 N");
  }
  if (!(study.payload >= 0.0 && study.payload <= 10.0)) {
    throw std::invalid_argument("--payload must be from 0 to 10 kg");
  }
  study.captures = options.text("mocap", "");
  study.json = options.text("json", "");
  options.refuse_unknown();
  if (all) {
    study.conditions = captured_conditions();
  } else {
    study.conditions = {condition_of(motion, gait)};
    world_config(study.conditions[0], 1).validate();
  }
  return study;
}

// Returns the number of falls.
std::size_t run(const Study& study) {
  std::ofstream json;
  if (!study.json.empty()) {
    json.open(study.json);
    if (!json) throw std::invalid_argument("--json = " + study.json + " cannot be written");
    json << "{\"conditions\": [";
  }
  const std::string urdf = study.captures.empty() ? installed_robot_description() : "";
  std::size_t falls = 0;
  for (std::size_t i = 0; i < study.conditions.size(); ++i) {
    const Outcome outcome = study.captures.empty() ? simulate(study, study.conditions[i], urdf)
                                                   : evaluate_capture(study, study.conditions[i]);
    print(outcome);
    if (study.falls) {
      std::printf("  %zu of %ld seeds fell within %.0f s; feet slide %.1f mm/s\n",
                  outcome.falls.size(), study.seeds, kWarmUp + study.duration, outcome.slip);
    }
    std::fflush(stdout);
    if (json.is_open()) json << (i == 0 ? "\n" : ",\n") << to_json(outcome);
    falls += outcome.falls.size();
  }
  if (json.is_open()) json << "\n]}\n";
  return falls;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(read_options(argc, argv)) == 0 ? 0 : 1;
  } catch (const std::invalid_argument& error) {
    std::cerr << "validate_motion: " << error.what() << "\n" << kUsage;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "validate_motion: " << error.what() << "\n";
    return 2;
  }
}
