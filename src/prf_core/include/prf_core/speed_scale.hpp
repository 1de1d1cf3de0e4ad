// SPDX-License-Identifier: BSD-3-Clause
// The share of its speed that an execution may have. Each change is announced before the tick from
// which it holds, so that all nodes make it at the same tick, however their topics interleave.
#pragma once

#include <deque>

#include "prf_core/require.hpp"
#include "prf_core/time.hpp"

namespace prf_core {

class SpeedScale {
 public:
  // `scale` is 0 to 1, else std::invalid_argument. One for an earlier tick than the last one
  // announced replaces those after it.
  void announce(Stamp from, double scale) {
    require_between("scale", scale, 0.0, 1.0);
    while (!coming_.empty() && coming_.back().from >= from) coming_.pop_back();
    if (coming_.size() >= kMost) coming_.pop_front();
    coming_.push_back({from, scale});
  }

  // At a tick; the ticks rise. 1 before the first announcement.
  [[nodiscard]] double at(Stamp tick) {
    while (!coming_.empty() && coming_.front().from <= tick) {
      scale_ = coming_.front().scale;
      coming_.pop_front();
    }
    return scale_;
  }

  // A new run.
  void reset() {
    coming_.clear();
    scale_ = 1.0;
  }

 private:
  static constexpr std::size_t kMost = 1000;  // many seconds of changes at every tick
  struct Announced {
    Stamp from;
    double scale;
  };
  std::deque<Announced> coming_;
  double scale_ = 1.0;
};

}  // namespace prf_core
