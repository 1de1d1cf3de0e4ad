// SPDX-License-Identifier: BSD-3-Clause
// For how long a condition has lasted. A break of at most `gap` does not end it, so that what comes
// and goes counts as lasting.
#pragma once

#include <optional>

#include "prf_decision/types.hpp"

namespace prf_decision {

class Lasting {
 public:
  void update(Stamp stamp, bool holds, Duration gap) {
    if (holds) {
      if (!since_) since_ = stamp;
      last_ = stamp;
    } else if (since_ && stamp - last_ > gap) {
      since_.reset();
    }
  }

  void reset() { since_.reset(); }

  [[nodiscard]] bool is_on() const { return since_.has_value(); }
  // 0: it does not hold.
  [[nodiscard]] Duration time(Stamp stamp) const { return since_ ? stamp - *since_ : Duration{0}; }

 private:
  std::optional<Stamp> since_;
  Stamp last_{0};  // that it held
};

}  // namespace prf_decision
