// SPDX-License-Identifier: BSD-3-Clause
#include "profile_reach.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace platform_sim {
namespace {

constexpr double kHorizon = 720.0;    // s
constexpr double kFinestTurn = 0.08;  // rad of the fastest sine between samples: cos(0.04) is 0.999

}  // namespace

Reach reach_of(const AxisProfile& axis) {
  Reach reach;
  for (const Sine& sine : axis.sines) {
    const double amplitude = std::abs(sine.amplitude) * std::cos(std::atan(sine.rate * axis.lag));
    reach.value += amplitude;
    reach.velocity += amplitude * sine.rate;
    reach.acceleration += amplitude * sine.rate * sine.rate;
  }
  return reach;
}

// Each sine is the imaginary part of a pointer that turns by the same angle from sample to sample.
Reach sampled_reach_of(const AxisProfile& axis) {
  struct Pointer {
    std::complex<double> now, turn;
    double rate;
  };
  std::vector<Pointer> pointers;
  double fastest = 0.1;
  for (const Sine& sine : axis.sines) fastest = std::max(fastest, sine.rate);
  const double step = kFinestTurn / fastest;
  for (const Sine& sine : axis.sines) {
    const double delay = std::atan(sine.rate * axis.lag);
    const std::complex<double> start =
        sine.amplitude * std::cos(delay) * std::polar(1.0, sine.phase - delay);
    pointers.push_back({start, std::polar(1.0, sine.rate * step), sine.rate});
  }
  Reach reach;
  for (double time = 0.0; time < kHorizon; time += step) {
    double value = 0.0, velocity = 0.0, acceleration = 0.0;
    for (Pointer& pointer : pointers) {
      value += pointer.now.imag();
      velocity += pointer.rate * pointer.now.real();
      acceleration += pointer.rate * pointer.rate * pointer.now.imag();
      pointer.now *= pointer.turn;
    }
    reach.value = std::max(reach.value, std::abs(value));
    reach.velocity = std::max(reach.velocity, std::abs(velocity));
    reach.acceleration = std::max(reach.acceleration, std::abs(acceleration));
  }
  return reach;
}

}  // namespace platform_sim
