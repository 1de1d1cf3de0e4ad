// SPDX-License-Identifier: BSD-3-Clause
// The clock of one stream of stamped data: is a stamp in order, or did the clock jump?
//
// A stamp s is compared with n, the newest one that the stream has accepted. J and A are the bounds
// ClockBounds::backward_jump and ClockBounds::far_ahead.
//
//   stamp           order                          what it is                      n becomes
//   none yet        kNewer                         the first of the stream         s
//   n < s <= n + A  kNewer                         in order                        s
//   s = n           kDuplicate                                                     n
//   n - J <= s < n  kOld                           out of order                    n
//   s < n - J       kOld, then kBackwardJump       late, or the clock went back    n, then s
//   s > n + A       kFarAhead, then kForwardJump   garbage, or the clock leapt     n, then s
//
// One message proves no jump: it may be late, doubled, or from another sender. In the last two rows
// the clock has jumped once `confirmations` messages in a row say so, each in order after the one
// before (by more than 0 and at most A). Only the last of them is accepted; a backward jump begins
// a new run there. So a real jump costs confirmations - 1 messages, and a clock that goes back by
// less than J is followed again when it reaches n.
//
// The result depends on the order of the stamps alone, never on the time of arrival. Stamps lie
// within the bounds of bounds.hpp.
#pragma once

#include <chrono>
#include <optional>

#include "prf_core/time.hpp"

namespace prf_core {

enum class StampOrder { kNewer, kDuplicate, kOld, kBackwardJump, kFarAhead, kForwardJump };

// Whether a message of this order belongs to the stream: it is the newest one now.
[[nodiscard]] constexpr bool is_accepted(StampOrder order) {
  return order == StampOrder::kNewer || order == StampOrder::kBackwardJump ||
         order == StampOrder::kForwardJump;
}

struct ClockBounds {
  Duration backward_jump = std::chrono::seconds(1);  // J >= 0
  Duration far_ahead = std::chrono::seconds(1);      // A > 0; max(): nothing is far ahead
  int confirmations = 3;                             // >= 1; with 1 each jump is believed at once
};

class ClockMonitor {
 public:
  explicit ClockMonitor(const ClockBounds& bounds = {}) : bounds_(bounds) {}

  // What observe() would return.
  [[nodiscard]] StampOrder classify(Stamp stamp) const {
    if (!newest_) return StampOrder::kNewer;
    const bool back = stamp < *newest_;
    if (!jumps_back(stamp) && !jumps_ahead(stamp)) {
      if (stamp == *newest_) return StampOrder::kDuplicate;
      return back ? StampOrder::kOld : StampOrder::kNewer;
    }
    const bool confirmed = in_a_row(stamp) >= bounds_.confirmations;
    if (back) return confirmed ? StampOrder::kBackwardJump : StampOrder::kOld;
    return confirmed ? StampOrder::kForwardJump : StampOrder::kFarAhead;
  }

  // Classifies the stamp and makes it the newest where the table says so.
  StampOrder observe(Stamp stamp) {
    const StampOrder order = classify(stamp);
    if (is_accepted(order)) {
      restart(stamp);
    } else {
      row_ = jumps_back(stamp) || jumps_ahead(stamp) ? in_a_row(stamp) : 0;
      last_ = stamp;
    }
    return order;
  }

  // Whether this stamp alone lies more than the bound before, or beyond, the newest one.
  [[nodiscard]] bool jumps_back(Stamp stamp) const {
    return newest_ && *newest_ - stamp > bounds_.backward_jump;
  }
  [[nodiscard]] bool jumps_ahead(Stamp stamp) const {
    return newest_ && stamp - *newest_ > bounds_.far_ahead;
  }

  [[nodiscard]] std::optional<Stamp> newest() const { return newest_; }

  // Makes `newest` the newest stamp, whatever was before. Without it the monitor is as it was
  // before its first stamp.
  void restart(std::optional<Stamp> newest = std::nullopt) {
    newest_ = newest;
    row_ = 0;
  }

 private:
  // How many stamps in a row speak for a jump, this one included. (One before and one beyond n lie
  // farther apart than A, so that they never follow each other.)
  [[nodiscard]] int in_a_row(Stamp stamp) const {
    if (row_ > 0 && stamp == last_) return row_;  // says nothing new
    const bool follows = row_ > 0 && stamp > last_ && stamp - last_ <= bounds_.far_ahead;
    return follows ? row_ + 1 : 1;
  }

  ClockBounds bounds_;
  std::optional<Stamp> newest_;
  Stamp last_{0};  // of those that speak for a jump
  int row_ = 0;    // how many of them there are
};

}  // namespace prf_core
