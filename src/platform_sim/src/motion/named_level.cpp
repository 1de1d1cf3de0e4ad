// SPDX-License-Identifier: BSD-3-Clause
#include "named_level.hpp"

#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>
#include <sstream>

namespace platform_sim {
namespace {

double number_of(const std::string& what, const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  const bool is_number = static_cast<bool>(stream >> value) && stream.peek() == EOF;
  prf_core::require(is_number && std::isfinite(value) && value >= 0.0, what, prf_core::quoted(text),
                    "a number of 0 or above");
  return value;
}

}  // namespace

std::optional<NamedLevel> named_level_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return std::nullopt;
  NamedLevel parsed;
  parsed.name = text.substr(0, colon);
  const std::string rest = text.substr(colon + 1);
  const std::size_t at = rest.find('@');
  parsed.level = number_of("level of " + prf_core::quoted(parsed.name), rest.substr(0, at));
  if (at != std::string::npos) {
    parsed.time = number_of("time of " + prf_core::quoted(parsed.name), rest.substr(at + 1));
  }
  return parsed;
}

}  // namespace platform_sim
