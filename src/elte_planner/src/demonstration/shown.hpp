// SPDX-License-Identifier: BSD-3-Clause
// Text from a file or a message as it may appear in a log line.
#pragma once

#include <string>
#include <string_view>

namespace elte_planner {

// At most `length` characters, one line; what is no printable ASCII becomes '?'.
inline std::string shown(std::string_view text, std::size_t length = 200) {
  std::string result(text.substr(0, length));
  for (char& c : result) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text.size() > length ? result + "..." : result;
}

}  // namespace elte_planner
