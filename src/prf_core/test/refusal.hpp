// SPDX-License-Identifier: BSD-3-Clause
// What a check says when it refuses, and numbers that most checks must refuse.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

namespace prf_core {

inline const double kNan = std::nan("");
inline const double kInf = std::numeric_limits<double>::infinity();

// The text of the std::invalid_argument that `check` throws; empty: it throws none.
inline std::string refusal(const std::function<void()>& check) {
  try {
    check();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace prf_core
