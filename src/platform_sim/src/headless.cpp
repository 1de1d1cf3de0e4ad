// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/headless.hpp"

#include <cmath>
#include <prf_core/require.hpp>

namespace platform_sim {
namespace {

constexpr int kStepsPerSecond = 1000;
constexpr double kLongest = 86400.0;  // s

}  // namespace

void run_headless(World& world, double duration, int rate,
                  const std::function<void(World&)>& sample) {
  prf_core::require_between("duration", duration, 0.0, kLongest, "s");
  prf_core::require(rate >= 1 && kStepsPerSecond % rate == 0, "rate", rate, "a divisor of 1000 Hz");
  const int steps_per_sample = kStepsPerSecond / rate;
  const auto samples = static_cast<long>(std::floor(duration * rate + 1e-9));
  sample(world);
  for (long i = 0; i < samples && !world.fallen(); ++i) {
    for (int step = 0; step < steps_per_sample; ++step) world.step();
    sample(world);
  }
}

}  // namespace platform_sim
