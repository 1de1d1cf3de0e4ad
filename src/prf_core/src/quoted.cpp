// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/quoted.hpp"

#include <string_view>
#include <utility>

namespace prf_core {
namespace {

std::string escaped(char character) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto code = static_cast<unsigned char>(character);
  if (character == '\n') return "\\n";
  if (character == '\t') return "\\t";
  if (character == '"' || character == '\\') return {'\\', character};
  if (code >= 0x20 && code < 0x7f) return {character};
  return {'\\', 'x', kDigits[code / 16], kDigits[code % 16]};
}

}  // namespace

std::string quoted(const std::string& text) {
  const std::string dots = "...";
  std::string result = "\"";
  std::size_t room = 0;  // so much of the result leaves room for the closing mark and the dots
  for (const char character : text) {
    result += escaped(character);
    if (result.size() + dots.size() + 1 <= kMaxQuoted) room = result.size();
    if (result.size() + 1 > kMaxQuoted) return result.substr(0, room) + "\"" + dots;
  }
  return result + "\"";
}

std::string quoted(std::string& text) { return quoted(std::as_const(text)); }
std::string quoted(const char* text) { return quoted(std::string(text)); }

}  // namespace prf_core
