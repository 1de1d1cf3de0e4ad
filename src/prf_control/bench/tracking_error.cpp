// SPDX-License-Identifier: BSD-3-Clause
// How far the hand is from a swaying target: arm controller and a stand-in for the arm, without a
// ROS graph. At each tick the set-point is where the target is `lead` later, with its velocity.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <jaco_kinematics/jaco_arm.hpp>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "prf_control/arm_controller.hpp"
#include "prf_control/nearest_pose.hpp"
#include "servo_arm.hpp"

namespace prf_control {
namespace {

using jaco_kinematics::forward;

struct BenchmarkParams {
  double amplitude = 0.05;  // m, along y of the arm's base
  double lead = 0.02;       // s
  double acceleration = 4;  // rad/s^2
  double velocity_scale = 0.95;
  std::string json;
};

struct Sine {
  double amplitude;  // m
  double frequency;  // rad/s
};
using Sway = std::vector<Sine>;

struct Row {
  std::string target;
  double frequency;       // rad/s, of the first sine
  double rms, p95, most;  // m
  double orientation;     // rad, the greatest
  double lag;             // s, of the first sine; negative: ahead
  double limited;         // share of the ticks
  bool within_limits;     // every command
};

JointVector home() { return (JointVector(7) << 0.3, 3.9, 0.2, 1.9, 0.4, 2.4, -0.3).finished(); }

ArmControllerParams controller_params(const BenchmarkParams& params) {
  return {{params.velocity_scale, params.acceleration, 0.3, 0.1, 0.5, 0.1, 0.2, 1.0},
          0.2,
          0.3,
          {"joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6", "joint_7"}};
}

PoseSetpoint target_at(const Sway& sway, double time) {
  PoseSetpoint target;
  target.hand_in_base = forward(home());
  for (const auto& [amplitude, frequency] : sway) {
    target.hand_in_base.translation().y() += amplitude * std::sin(frequency * time);
    target.linear_velocity.y() += amplitude * frequency * std::cos(frequency * time);
  }
  return target;
}

// The part of the signal at one frequency: its share in phase and in quadrature.
struct Phasor {
  double in_phase = 0;
  double quadrature = 0;

  void add(double value, double phase) {
    in_phase += value * std::sin(phase);
    quadrature += value * std::cos(phase);
  }
};

bool keeps_limits(const MotionState& before, const MotionState& after,
                  const BenchmarkParams& params) {
  constexpr double kRounding = 1e-9;
  const auto& limits = jaco_kinematics::jaco_joint_limits();
  const JointVector change = (after.velocity - before.velocity) / ServoArm::kPeriod;
  return ((after.velocity.cwiseAbs() - params.velocity_scale * limits.velocity).maxCoeff() <=
          kRounding) &&
         change.cwiseAbs().maxCoeff() <= params.acceleration + 1e2 * kRounding &&
         (after.position - limits.lower).minCoeff() >= 0 &&
         (limits.upper - after.position).minCoeff() >= 0;
}

// One period to settle, four to measure.
Row measure(const std::string& name, const Sway& sway, const BenchmarkParams& params) {
  ArmController controller(std::make_shared<jaco_kinematics::JacoArm>(), controller_params(params));
  ServoArm arm{home()};
  const double frequency = sway.front().frequency;
  const double middle = forward(home()).translation().y();
  const int ticks = static_cast<int>(5 * 2 * M_PI / frequency / ServoArm::kPeriod);
  Row row{name, frequency, 0, 0, 0, 0, 0, 0, true};
  std::vector<double> errors;
  Phasor hand;
  MotionState before{home(), JointVector::Zero(7)};
  for (int i = 0; i < ticks; ++i) {
    const double now = i * ServoArm::kPeriod;
    Setpoint setpoint;
    setpoint.kind = SetpointKind::kPose;
    setpoint.pose = target_at(sway, now + params.lead);
    const prf_core::Stamp stamp = i * std::chrono::milliseconds(10);
    controller.add_joints({stamp, arm.position, ""});
    const ControlResult result = controller.add_setpoint(stamp, setpoint).front();
    row.within_limits = row.within_limits && keeps_limits(before, *result.command, params);
    before = *result.command;
    arm.run(*result.command);
    if (i < ticks / 5) continue;
    const double later = now + ServoArm::kPeriod;
    const auto error = pose_error(forward(arm.position), target_at(sway, later).hand_in_base);
    errors.push_back(error.head<3>().norm());
    row.orientation = std::max(row.orientation, error.tail<3>().norm());
    hand.add(forward(arm.position).translation().y() - middle, frequency * later);
    row.limited += result.code == ControlCode::kFollowing ? 0 : 1;
  }
  std::sort(errors.begin(), errors.end());
  const double count = static_cast<double>(errors.size());
  for (const double error : errors) row.rms += error * error / count;
  row.rms = std::sqrt(row.rms);
  row.p95 = errors[static_cast<std::size_t>(0.95 * (count - 1))];
  row.most = errors.back();
  row.lag = -std::atan2(hand.quadrature, hand.in_phase) / frequency;
  row.limited /= count;
  return row;
}

std::vector<Row> run(const BenchmarkParams& params) {
  std::vector<Row> rows;
  for (const double frequency : {0.5, 1.0, 2.0, 3.0}) {
    rows.push_back(measure("sway", {{params.amplitude, frequency}}, params));
  }
  const double a = params.amplitude;
  rows.push_back(measure("sway, steps at 12 rad/s", {{a, 2.4}, {0.2 * a, 12.0}}, params));
  return rows;
}

void print_table(const std::vector<Row>& rows) {
  std::printf("%-24s%7s%9s%9s%9s%10s%9s%9s%11s%9s\n", "target", "rad/s", "rms mm", "p95 mm",
              "max mm", "max deg", "lag ms", "lag deg", "limited %", "limits");
  for (const Row& row : rows) {
    std::printf("%-24s%7.1f%9.2f%9.2f%9.2f%10.3f%9.2f%9.2f%11.1f%9s\n", row.target.c_str(),
                row.frequency, 1e3 * row.rms, 1e3 * row.p95, 1e3 * row.most,
                row.orientation * 180 / M_PI, 1e3 * row.lag, row.lag * row.frequency * 180 / M_PI,
                100 * row.limited, row.within_limits ? "kept" : "BROKEN");
  }
}

void write_json(const std::vector<Row>& rows, const BenchmarkParams& params) {
  nlohmann::ordered_json out = {{"amplitude_m", params.amplitude},
                                {"lead_s", params.lead},
                                {"acceleration_rad_per_s2", params.acceleration},
                                {"velocity_scale", params.velocity_scale}};
  for (const Row& row : rows) {
    out["rows"].push_back({{"target", row.target},
                           {"frequency_rad_per_s", row.frequency},
                           {"rms_position_error_m", row.rms},
                           {"p95_position_error_m", row.p95},
                           {"max_position_error_m", row.most},
                           {"max_orientation_error_rad", row.orientation},
                           {"lag_s", row.lag},
                           {"limited_share", row.limited},
                           {"within_limits", row.within_limits}});
  }
  std::ofstream file(params.json);
  file << out.dump(1) << '\n';
  if (!file.flush())
    throw std::invalid_argument(
        "--json " + params.json +
        " cannot be written: is its folder there, and may this user write to it?");
}

}  // namespace
}  // namespace prf_control

int main(int argc, char** argv) {
  using namespace prf_control;
  BenchmarkParams params;
  CLI::App app("How far the hand is from a target that sways sideways, for four frequencies.");
  const auto add = [&](const char* name, double& value, double least, double most,
                       const char* meaning) {
    app.add_option(name, value, meaning)->check(CLI::Range(least, most))->capture_default_str();
  };
  add("--amplitude", params.amplitude, 1e-6, 0.3, "of the target, m");
  add("--lead", params.lead, 0, 1, "of the set-point, s");
  add("--acceleration", params.acceleration, 1e-3, 100, "limit of the joints, rad/s^2");
  add("--velocity-scale", params.velocity_scale, 1e-3, 1, "share of the joints' velocity limits");
  app.add_option("--json", params.json, "also write the figures to this file");
  try {
    app.parse(argc, argv);
    const std::vector<Row> rows = run(params);
    print_table(rows);
    if (!params.json.empty()) write_json(rows, params);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << "tracking_error: " << error.what() << '\n';
    return 2;
  }
  return 0;
}
