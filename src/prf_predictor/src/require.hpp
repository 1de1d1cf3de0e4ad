// SPDX-License-Identifier: BSD-3-Clause
// The form of every complaint about an argument: name, value, bound.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace prf_predictor {

template <typename Value>
void require(bool holds, const std::string& name, const Value& value, const std::string& bound) {
  if (holds) return;
  std::ostringstream text;
  text << name << " = " << value << ", must be " << bound;
  throw std::invalid_argument(text.str());
}

}  // namespace prf_predictor
