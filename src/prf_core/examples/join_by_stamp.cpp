// SPDX-License-Identifier: BSD-3-Clause
// Joins ticks with the set-points of their stamps, although the set-points come late and one is
// missing.
#include <iostream>
#include <prf_core/stream_joiner.hpp>
#include <string>

int main() {
  using std::chrono::milliseconds;
  prf_core::JoinParams params;
  params.max_wait = milliseconds(300);
  prf_core::StreamJoiner<std::string, double> joiner(params);

  joiner.push_primary(milliseconds(10), "first tick");
  joiner.push_primary(milliseconds(20), "second tick");
  joiner.push_secondary(milliseconds(20), 0.5);  // none for the first tick: it was never sent
  int joined_ticks = 0;
  while (const auto joined = joiner.pop()) {
    std::cout << joined->primary << ": "
              << (joined->secondary ? std::to_string(*joined->secondary) : "alone") << "\n";
    ++joined_ticks;
  }
  return joined_ticks == 2 ? 0 : 1;
}
