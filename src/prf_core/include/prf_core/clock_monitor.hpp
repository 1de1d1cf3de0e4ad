// SPDX-License-Identifier: BSD-3-Clause
// The clock of one stream of stamped data: is a stamp in order, or did the clock jump?
//
// A stamp s is compared with n, the newest one that the stream has accepted. J and A are the bounds
// ClockBounds::backward_jump and ClockBounds::far_ahead.
//
//   stamp           order           what it is                                   n becomes
//   none yet        kNewer          the first of the stream                      s
//   n < s <= n + A  kNewer          in order                                     s
//   s = n           kDuplicate                                                   n
//   n - J <= s < n  kOld            out of order                                 n
//   s < n - J       kBackwardJump   the clock went back: a new run begins here   s
//   s > n + A       kFarAhead       garbage, or the clock leapt forward          n
//
// After a true leap forward by more than A every stamp is kFarAhead until restart() is called;
// FarAheadHold below does that. The result depends on the order of the stamps alone, never on the
// time of arrival.
#pragma once

#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "prf_core/time.hpp"

namespace prf_core {

enum class StampOrder { kNewer, kDuplicate, kOld, kBackwardJump, kFarAhead };

struct ClockBounds {
  Duration backward_jump = std::chrono::seconds(1);  // J; 0: every step back begins a new run
  Duration far_ahead = Duration::max();              // A; the default: nothing is far ahead
};

class ClockMonitor {
 public:
  explicit ClockMonitor(const ClockBounds& bounds = {}) : bounds_(bounds) {}

  [[nodiscard]] StampOrder classify(Stamp stamp) const {
    if (!newest_) return StampOrder::kNewer;
    if (stamp == *newest_) return StampOrder::kDuplicate;
    if (stamp < *newest_) {
      const bool jumped = *newest_ - stamp > bounds_.backward_jump;
      return jumped ? StampOrder::kBackwardJump : StampOrder::kOld;
    }
    return stamp - *newest_ > bounds_.far_ahead ? StampOrder::kFarAhead : StampOrder::kNewer;
  }

  // Classifies the stamp and makes it the newest where the table says so.
  StampOrder observe(Stamp stamp) {
    const StampOrder order = classify(stamp);
    if (order == StampOrder::kNewer || order == StampOrder::kBackwardJump) newest_ = stamp;
    return order;
  }

  [[nodiscard]] std::optional<Stamp> newest() const { return newest_; }

  // Makes `newest` the newest stamp, whatever was before. Without it the monitor is as it was
  // before its first stamp.
  void restart(std::optional<Stamp> newest = std::nullopt) { newest_ = newest; }

 private:
  ClockBounds bounds_;
  std::optional<Stamp> newest_;
};

// Tells a single wrong stamp far in the future from a clock that leapt forward. A message whose
// stamp h is more than `bound` beyond the newest stamp n is held. The next message, with stamp s,
// decides what becomes of it:
//
//   s >= h - bound   the clock leapt: the held message passes and h becomes the newest stamp
//   s <  h - bound   h was wrong: the held message is refuted, that is dropped, and n stays
//
// After that s itself is compared with the newest stamp, and held if it is far ahead of that.
// Duplicate and old messages pass too, with their order: the caller decides about them.
template <typename Message>
class FarAheadHold {
 public:
  struct Passed {
    Stamp stamp;
    StampOrder order;  // kFarAhead: it was held and passes now
    Message message;
  };
  struct Result {
    std::vector<Passed> passed;  // in order of arrival
    bool refuted = false;        // whether the held message was dropped
  };

  // `bound` >= 0 is both bounds of the clock: far ahead and backward jump.
  explicit FarAheadHold(Duration bound) : bound_(bound), clock_({bound, bound}) {}

  Result push(Stamp stamp, Message message) {
    Result result;
    if (held_) {
      result.refuted = held_->stamp - stamp > bound_;
      if (!result.refuted) {
        clock_.restart(held_->stamp);
        result.passed.push_back(std::move(*held_));
      }
      held_.reset();
    }
    Passed next{stamp, clock_.observe(stamp), std::move(message)};
    if (next.order == StampOrder::kFarAhead) {
      held_ = std::move(next);
    } else {
      result.passed.push_back(std::move(next));
    }
    return result;
  }

 private:
  Duration bound_;
  ClockMonitor clock_;
  std::optional<Passed> held_;
};

}  // namespace prf_core
