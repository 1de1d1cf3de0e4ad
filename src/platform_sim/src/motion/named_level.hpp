// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace platform_sim {

/// "NAME:LEVEL" or "NAME:LEVEL@TIME".
struct NamedLevel {
  std::string name;
  double level = 0.0;
  std::optional<double> time;  ///< s
};

/// Nothing if there is no colon. Throws std::invalid_argument if what follows is no finite number
/// of 0 or above.
[[nodiscard]] std::optional<NamedLevel> named_level_of(const std::string& text);

}  // namespace platform_sim
