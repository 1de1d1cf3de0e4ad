// SPDX-License-Identifier: BSD-3-Clause
// Text from outside, made fit for a log line: in quotation marks, at most 200 characters, with
// everything but printable ASCII escaped, as in "link\n\x1b[2J". A longer text ends in "... after
// the closing mark.
#pragma once

#include <cstddef>
#include <string>

namespace prf_core {

inline constexpr std::size_t kMaxQuoted = 200;  // characters, quotation marks and dots included

// One for each kind of argument, so that none is taken for std::quoted, which has no limit.
[[nodiscard]] std::string quoted(const std::string& text);
[[nodiscard]] std::string quoted(std::string& text);
[[nodiscard]] std::string quoted(const char* text);

}  // namespace prf_core
