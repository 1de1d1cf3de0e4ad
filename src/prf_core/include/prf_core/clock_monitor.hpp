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

  // Classifies the stamp and makes it the newest where the table says so.
  StampOrder observe(Stamp stamp) {
    if (!newest_) return accept(stamp, StampOrder::kNewer);
    if (!jumps_back(stamp) && !jumps_ahead(stamp)) {
      jump_.reset();
      if (stamp > *newest_) return accept(stamp, StampOrder::kNewer);
      return stamp == *newest_ ? StampOrder::kDuplicate : StampOrder::kOld;
    }
    const bool back = stamp < *newest_;
    if (confirm(stamp) < bounds_.confirmations) {
      return back ? StampOrder::kOld : StampOrder::kFarAhead;
    }
    return accept(stamp, back ? StampOrder::kBackwardJump : StampOrder::kForwardJump);
  }

  // What observe() would return.
  [[nodiscard]] StampOrder classify(Stamp stamp) const {
    return ClockMonitor(*this).observe(stamp);
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
    jump_.reset();
  }

 private:
  // Consecutive stamps that say that the clock has jumped.
  struct Jump {
    Stamp last;
    int stamps = 1;
  };

  StampOrder accept(Stamp stamp, StampOrder order) {
    restart(stamp);
    return order;
  }

  // How many stamps in a row speak for a jump, this one included.
  int confirm(Stamp stamp) {
    const bool same_way = jump_ && (jump_->last < *newest_) == (stamp < *newest_);
    const bool follows =
        same_way && stamp > jump_->last && stamp - jump_->last <= bounds_.far_ahead;
    const bool repeats = jump_ && stamp == jump_->last;  // says nothing new
    if (repeats) return jump_->stamps;
    jump_ = Jump{stamp, follows ? jump_->stamps + 1 : 1};
    return jump_->stamps;
  }

  ClockBounds bounds_;
  std::optional<Stamp> newest_;
  std::optional<Jump> jump_;
};

}  // namespace prf_core
