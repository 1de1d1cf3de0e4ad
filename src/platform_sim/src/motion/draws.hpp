// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace platform_sim {

/// Random numbers that are the same on every machine. `stream` keeps the draws of one purpose
/// apart from others of the same seed.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t stream) : generator_(seed ^ stream) {}

  [[nodiscard]] double uniform(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(generator_() >> 11), -53);
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace platform_sim
