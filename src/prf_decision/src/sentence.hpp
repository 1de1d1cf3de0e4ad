// SPDX-License-Identifier: BSD-3-Clause
// Private: figures in reasons, always with the same decimals.
#pragma once

#include <iomanip>
#include <sstream>
#include <string>

namespace prf_decision {

template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2);
  (text << ... << parts);
  return text.str();
}

}  // namespace prf_decision
