// SPDX-License-Identifier: BSD-3-Clause
// A StreamJoiner of numbers: each message is its own stamp in ms.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "prf_core/stream_joiner.hpp"

namespace prf_core {

using Joiner = StreamJoiner<int, int>;

inline Joiner joiner_with(Duration max_wait) { return Joiner({max_wait}); }

inline StampOrder primary(Joiner& joiner, int ms) {
  return joiner.push_primary(std::chrono::milliseconds(ms), ms);
}
inline StampOrder secondary(Joiner& joiner, int ms) {
  return joiner.push_secondary(std::chrono::milliseconds(ms), ms);
}

// "10=10" joined, "10=-" alone, "*" before the first of a new run.
inline std::string decided(Joiner& joiner) {
  std::string text;
  while (const auto joined = joiner.pop()) {
    EXPECT_EQ(joined->stamp, std::chrono::milliseconds(joined->primary));
    if (joined->new_run) text += "*";
    text += std::to_string(joined->primary) + "=" +
            (joined->secondary ? std::to_string(*joined->secondary) : "-") + " ";
  }
  return text;
}

inline void primaries(Joiner& joiner, const std::vector<int>& stamps_ms) {
  for (const int ms : stamps_ms) primary(joiner, ms);
}
inline void secondaries(Joiner& joiner, const std::vector<int>& stamps_ms) {
  for (const int ms : stamps_ms) secondary(joiner, ms);
}

}  // namespace prf_core
