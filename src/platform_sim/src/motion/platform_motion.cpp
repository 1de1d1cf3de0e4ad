// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/platform_motion.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRampDuration = 2.0;  // s
constexpr double kRampRate = kPi / kRampDuration;
constexpr double kLongestPhaseTime = 20.0;       // s, seeds draw t0 from [0, this)
const Eigen::Vector3d kPivot(-0.1, 0.0, -0.16);  // in the platform frame, m

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

// Steady response of lag dy/dt + y = sin(rate t + phase).
double lagged_sine(double rate, double phase, double lag, double time) {
  const double delay = std::atan(rate * lag);
  return std::cos(delay) * std::sin(rate * time + phase - delay);
}

// Steady response to (1 - cos(W t))/2 sin(w t + p)
//   = sin(w t + p)/2 - sin((w + W) t + p)/4 - sin((w - W) t + p)/4.
double lagged_ramped_sine(double rate, double phase, double lag, double time) {
  return 0.5 * lagged_sine(rate, phase, lag, time) -
         0.25 * lagged_sine(rate + kRampRate, phase, lag, time) -
         0.25 * lagged_sine(rate - kRampRate, phase, lag, time);
}

// The lag's response from rest: steady response of each stretch plus its decaying transient.
double lagged_command(double rate, double phase, double lag, double time) {
  const auto ramped = [&](double t) {
    return lagged_ramped_sine(rate, phase, lag, t) -
           lagged_ramped_sine(rate, phase, lag, 0.0) * std::exp(-t / lag);
  };
  if (time < kRampDuration) return ramped(time);
  const double jump = ramped(kRampDuration) - lagged_sine(rate, phase, lag, kRampDuration);
  return lagged_sine(rate, phase, lag, time) + jump * std::exp(-(time - kRampDuration) / lag);
}

PlatformMotion::AxisState state_of(const Sine& sine, double lag, double t0, double time) {
  const double phase = sine.rate * t0 + sine.phase;
  const double command = ramp(time) * std::sin(sine.rate * time + phase);
  PlatformMotion::AxisState state;
  if (lag > 0.0) {
    state.value = lagged_command(sine.rate, phase, lag, time);
    state.velocity = (command - state.value) / lag;
  } else {
    state.value = command;
    state.velocity = ramp_rate(time) * std::sin(sine.rate * time + phase) +
                     ramp(time) * sine.rate * std::cos(sine.rate * time + phase);
  }
  return {sine.amplitude * state.value, sine.amplitude * state.velocity};
}

Eigen::Matrix3d turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

}  // namespace

PlatformMotion::PlatformMotion(const std::string& motion, std::optional<std::uint64_t> seed)
    : profile_(find_profile(motion, seed.value_or(0))),
      start_phase_time_(seed ? draw_phase_time(*seed) : 0.0) {}

PlatformMotion::AxisState PlatformMotion::axis(Axis axis, double time) const {
  AxisState state;
  if (time <= 0.0) return state;
  const auto index = static_cast<std::size_t>(axis);
  const PlayPattern::State played =
      profile_.pattern ? profile_.pattern->at(time) : PlayPattern::State{1.0, 0.0, time, 1.0};
  for (const Sine& sine : profile_.axes[index].sines) {
    const AxisState part =
        state_of(sine, profile_.axes[index].lag, start_phase_time_, played.place);
    state.value += part.value;
    state.velocity += part.velocity;
  }
  if (profile_.pattern) {
    state = {played.amount * state.value,
             played.amount_rate * state.value + played.amount * played.speed * state.velocity};
  }
  if (!profile_.recording) return state;
  const auto& columns = profile_.recording->columns();
  const auto found = std::find(columns.begin(), columns.end(), kAxisNames[index]);
  if (found == columns.end()) return state;
  const Eigen::Index column = found - columns.begin();
  const RecordedMotion::Sample sample = profile_.recording->at(time);
  state.value += ramp(time) * sample.values[column];
  state.velocity +=
      ramp_rate(time) * sample.values[column] + ramp(time) * sample.velocities[column];
  return state;
}

// w = yaw' z + Rz (pitch' y + Ry roll' x).
FrameState PlatformMotion::deck(double time) const {
  const AxisState surge = axis(Axis::kSurge, time), sway = axis(Axis::kSway, time),
                  heave = axis(Axis::kHeave, time), roll = axis(Axis::kRoll, time),
                  pitch = axis(Axis::kPitch, time), yaw = axis(Axis::kYaw, time);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d yawed = turn(yaw.value, z);
  const Eigen::Matrix3d pitched = yawed * turn(pitch.value, y);
  FrameState deck;
  deck.pose.linear() = pitched * turn(roll.value, x);
  deck.angular = yaw.velocity * z + pitch.velocity * (yawed * y) + roll.velocity * (pitched * x);
  const Eigen::Vector3d pivot_to_deck = -(deck.pose.linear() * kPivot);
  deck.pose.translation() =
      Eigen::Vector3d(surge.value, sway.value, heave.value) + kPivot + pivot_to_deck;
  deck.linear = Eigen::Vector3d(surge.velocity, sway.velocity, heave.velocity) +
                deck.angular.cross(pivot_to_deck);
  return deck;
}

}  // namespace platform_sim
