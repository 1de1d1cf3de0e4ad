// SPDX-License-Identifier: BSD-3-Clause
// Checks of arguments and parameters. To refuse a value is to throw std::invalid_argument with its
// name, the value, and the bound with its unit, as in
//   "coast_after = -1, must be > 0 s".
// Not-a-number fails every bound of the functions below.
#pragma once

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

namespace prf_core {

// `bound` completes "must be ...".
template <typename Value>
void require(bool holds, const std::string& name, const Value& value, const std::string& bound) {
  if (holds) return;
  std::ostringstream text;
  text << name << " = " << value << ", must be " << bound;
  throw std::invalid_argument(text.str());
}

inline void require_finite(const std::string& name, double value) {
  require(std::isfinite(value), name, value, "finite");
}

// Both bounds are included. An infinite `high` stands for "no upper bound" and admits infinity.
inline void require_between(const std::string& name, double value, double low, double high,
                            const std::string& unit = "") {
  if (value >= low && value <= high) return;
  std::ostringstream bound;
  bound << "within [" << low << ", " << high << "]" << (unit.empty() ? "" : " ") << unit;
  require(false, name, value, bound.str());
}

inline void require_positive(const std::string& name, double value, const std::string& unit = "") {
  require(value > 0.0, name, value, unit.empty() ? "> 0" : "> 0 " + unit);
}

// 0 excluded, `high` included.
inline void require_positive_up_to(const std::string& name, double value, double high,
                                   const std::string& unit = "") {
  if (value > 0.0 && value <= high) return;
  std::ostringstream bound;
  bound << "> 0 and <= " << high << (unit.empty() ? "" : " ") << unit;
  require(false, name, value, bound.str());
}

}  // namespace prf_core
