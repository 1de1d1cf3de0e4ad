// SPDX-License-Identifier: BSD-3-Clause
// The clock of one stream of stamped data: is a stamp in order, or did the clock jump?
//
// A stamp s is compared with the newest one n that the stream has accepted, bounds J and A:
//
//   stamp           order           what it is                                   n becomes
//   none yet        kNewer          the first of the stream                      s
//   n < s <= n + A  kNewer          in order                                     s
//   s = n           kDuplicate                                                   n
//   n - J <= s < n  kOld            out of order                                 n
//   s < n - J       kBackwardJump   the clock went back: a new run begins here   s
//   s > n + A       kFarAhead       garbage, or the clock leapt forward          n
//
// The result depends on the order of the stamps alone, never on the time of arrival.
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

  // Goes on from `newest`, whatever was before; none: as if nothing had come.
  void restart(std::optional<Stamp> newest = std::nullopt) { newest_ = newest; }

 private:
  ClockBounds bounds_;
  std::optional<Stamp> newest_;
};

// Tells a single wrong stamp far in the future from a clock that leapt forward: a message more than
// `bound` ahead is held until the next message decides.
//
//   next stamp s, held stamp h    held message
//   s >= h - bound                passes, the clock goes on from h
//   s <  h - bound                refuted: it is dropped
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
    bool refuted = false;        // the held message
  };

  // `bound` also is the bound of a backward jump.
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
