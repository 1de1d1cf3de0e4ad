// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/platform_motion.hpp"

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180.0;
constexpr double kRampDuration = 2.0;  // s
constexpr double kRampRate = kPi / kRampDuration;
constexpr double kPitchLag = 0.42;                   // s
constexpr double kLongestPhaseTime = 20.0;           // s, seeds draw t0 from [0, this)
const Eigen::Vector3d kPitchAxis(-0.1, 0.0, -0.16);  // a point of the axis in the platform frame

// The heavy preset's command leads so that the realised pitch lags the sway by 0.64 rad, as it was
// measured on the treadmill that the presets describe.
const std::array<std::pair<std::string, PlatformMotionParams>, 3> kPresets{{
    {"none", {}},
    {"light", {0.05, 2.0, 3.0 * kDegree, 1.5, 0.0}},
    {"heavy", {0.05, 2.4, 8.0 * kDegree, 2.4, 0.15}},
}};

PlatformMotionParams find_preset(const std::string& name) {
  std::string valid;
  for (const auto& [preset, params] : kPresets) {
    if (preset == name) return params;
    valid += (valid.empty() ? "" : ", ") + preset;
  }
  throw std::invalid_argument("motion is '" + name + "', must be one of: " + valid);
}

double draw_phase_time(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  return kLongestPhaseTime * std::ldexp(static_cast<double>(generator() >> 11), -53);
}

double ramp(double time) {
  return time < kRampDuration ? 0.5 * (1.0 - std::cos(kRampRate * time)) : 1.0;
}

double ramp_rate(double time) {
  return time < kRampDuration ? 0.5 * kRampRate * std::sin(kRampRate * time) : 0.0;
}

// Steady answer of tau dy/dt + y = sin(rate t + phase).
double lagged_sine(double rate, double phase, double time) {
  const double delay = std::atan(rate * kPitchLag);
  return std::cos(delay) * std::sin(rate * time + phase - delay);
}

// Steady answer to (1 - cos(W t))/2 sin(w t + p)
//   = sin(w t + p)/2 - sin((w + W) t + p)/4 - sin((w - W) t + p)/4.
double lagged_ramped_sine(double rate, double phase, double time) {
  return 0.5 * lagged_sine(rate, phase, time) - 0.25 * lagged_sine(rate + kRampRate, phase, time) -
         0.25 * lagged_sine(rate - kRampRate, phase, time);
}

// The lag's answer from rest: steady answer of each stretch plus its decaying transient.
double lagged_command(double rate, double phase, double time) {
  const auto ramped = [&](double t) {
    return lagged_ramped_sine(rate, phase, t) -
           lagged_ramped_sine(rate, phase, 0.0) * std::exp(-t / kPitchLag);
  };
  if (time < kRampDuration) return ramped(time);
  const double jump = ramped(kRampDuration) - lagged_sine(rate, phase, kRampDuration);
  return lagged_sine(rate, phase, time) + jump * std::exp(-(time - kRampDuration) / kPitchLag);
}

}  // namespace

PlatformMotion::PlatformMotion(const std::string& preset, std::optional<std::uint64_t> seed)
    : params_(find_preset(preset)), start_phase_time_(seed ? draw_phase_time(*seed) : 0.0) {}

const std::vector<std::string>& PlatformMotion::preset_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const auto& preset : kPresets) result.push_back(preset.first);
    return result;
  }();
  return names;
}

double PlatformMotion::sway(double time) const {
  if (time <= 0.0) return 0.0;
  const double angle = params_.sway_rate * (time + start_phase_time_);
  return params_.sway_amplitude * ramp(time) * std::sin(angle);
}

double PlatformMotion::sway_velocity(double time) const {
  if (time <= 0.0) return 0.0;
  const double angle = params_.sway_rate * (time + start_phase_time_);
  return params_.sway_amplitude *
         (ramp_rate(time) * std::sin(angle) + ramp(time) * params_.sway_rate * std::cos(angle));
}

double PlatformMotion::pitch(double time) const {
  if (time <= 0.0) return 0.0;
  const double phase = params_.pitch_rate * start_phase_time_ + params_.pitch_phase;
  return params_.pitch_amplitude * lagged_command(params_.pitch_rate, phase, time);
}

double PlatformMotion::pitch_velocity(double time) const {
  if (time <= 0.0) return 0.0;
  const double phase = params_.pitch_rate * start_phase_time_ + params_.pitch_phase;
  const double command =
      params_.pitch_amplitude * ramp(time) * std::sin(params_.pitch_rate * time + phase);
  return (command - pitch(time)) / kPitchLag;
}

FrameState PlatformMotion::deck(double time) const {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(pitch(time), Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Vector3d axis_to_deck = -(rotation * kPitchAxis);
  FrameState deck;
  deck.pose.linear() = rotation;
  deck.pose.translation() = Eigen::Vector3d(0.0, sway(time), 0.0) + kPitchAxis + axis_to_deck;
  deck.angular = pitch_velocity(time) * Eigen::Vector3d::UnitY();
  deck.linear = Eigen::Vector3d(0.0, sway_velocity(time), 0.0) + deck.angular.cross(axis_to_deck);
  return deck;
}

}  // namespace platform_sim
