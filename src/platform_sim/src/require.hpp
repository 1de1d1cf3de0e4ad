// SPDX-License-Identifier: BSD-3-Clause
// Refusals that name the value and its bounds.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace platform_sim {

inline void require_finite(const std::string& name, double value) {
  if (!std::isfinite(value)) throw std::invalid_argument(name + " is not finite");
}

inline void require_between(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(name + " is " + std::to_string(value) + ", must be from " +
                              std::to_string(low) + " to " + std::to_string(high));
}

}  // namespace platform_sim
