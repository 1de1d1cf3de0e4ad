// SPDX-License-Identifier: BSD-3-Clause
// The clock of one stream of stamped data: is a stamp in order, or did the clock jump?
//
// A stamp s is compared with n, the newest one that the stream has accepted. J and A are the bounds
// ClockBounds::backward_jump and ClockBounds::far_ahead; E <= A is the lead that one stamp may
// have.
//
//   stamp           order                          what it is                      n becomes
//   none yet        kNewer                         the first of the stream         s
//   n < s <= n + E  kNewer                         in order                        s
//   s = n           kDuplicate                                                     n
//   n - J <= s < n  kOld                           out of order                    n
//   s < n - J       kOld, then kBackwardJump       late, or the clock went back    n, then s
//   s > n + E       kFarAhead, then kNewer         early, or there was a gap       n, then s
//   s > n + A       kFarAhead, then kForwardJump   garbage, or the clock leapt     n, then s
//
// One message proves no jump: it may be late, early, doubled, or from another sender. In the last
// three rows the clock has jumped once several messages in a row say so, each in order after the
// one before (by more than 0 and at most A): `confirmations` for a jump, two for a gap. Only the
// last of them is accepted; a backward jump begins a new run there. So a real jump costs
// confirmations - 1 messages, a gap one, and a clock that goes back by less than J is followed
// again when it reaches n.
//
// E is kGaps times the longest of the latest kPeriods steps of n, and at least kShortestLead: an
// early stamp that was accepted would make the stream's own messages old until it is reached.
// Before so many steps are known, E = A. A confirmed gap counts as a step, so that a stream with
// many gaps is soon taken as it is.
//
// The result depends on the order of the stamps alone, never on the time of arrival. Stamps lie
// within the bounds of bounds.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
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
  static constexpr std::size_t kPeriods = 8;
  static constexpr int kGaps = 5;
  static constexpr Duration kShortestLead = std::chrono::milliseconds(20);

  explicit ClockMonitor(const ClockBounds& bounds = {}) : bounds_(bounds) {}

  // What observe() would return.
  [[nodiscard]] StampOrder classify(Stamp stamp) const {
    if (!newest_) return StampOrder::kNewer;
    if (stamp == *newest_) return StampOrder::kDuplicate;
    const int row = in_a_row(stamp);
    if (stamp < *newest_) {
      const bool confirmed = jumps_back(stamp) && row >= bounds_.confirmations;
      return confirmed ? StampOrder::kBackwardJump : StampOrder::kOld;
    }
    if (jumps_ahead(stamp)) {
      return row >= bounds_.confirmations ? StampOrder::kForwardJump : StampOrder::kFarAhead;
    }
    const bool confirmed = row >= std::min(bounds_.confirmations, 2);
    return is_early(stamp) && !confirmed ? StampOrder::kFarAhead : StampOrder::kNewer;
  }

  // Classifies the stamp and makes it the newest where the table says so.
  StampOrder observe(Stamp stamp) {
    const StampOrder order = classify(stamp);
    if (is_accepted(order)) {
      if (order == StampOrder::kNewer && newest_) add_step(stamp - *newest_);
      newest_ = stamp;
      row_ = 0;
    } else {
      row_ = in_a_row(stamp);
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
    steps_ = 0;
  }

 private:
  // Whether this stamp alone is farther ahead than the stream's own steps explain.
  [[nodiscard]] bool is_early(Stamp stamp) const {
    if (steps_ < kPeriods || bounds_.far_ahead == Duration::max()) return false;
    const Duration longest = *std::max_element(step_.begin(), step_.end());
    return stamp - *newest_ > std::max(kGaps * longest, kShortestLead);
  }

  void add_step(Duration step) { step_[steps_++ % kPeriods] = step; }

  // How many stamps in a row speak for a jump or a gap, this one included; 0: it does not.
  [[nodiscard]] int in_a_row(Stamp stamp) const {
    const bool is_ahead = jumps_ahead(stamp) || is_early(stamp);
    if (!is_ahead && !jumps_back(stamp)) return 0;
    if (row_ > 0 && stamp == last_) return row_;  // says nothing new
    const bool same_side = (last_ > *newest_) == (stamp > *newest_);
    const bool follows =
        row_ > 0 && same_side && stamp > last_ && stamp - last_ <= bounds_.far_ahead;
    return follows ? row_ + 1 : 1;
  }

  ClockBounds bounds_;
  std::optional<Stamp> newest_;
  Stamp last_{0};                          // of those that speak for a jump
  int row_ = 0;                            // how many of them there are
  std::array<Duration, kPeriods> step_{};  // the latest ones of n
  std::size_t steps_ = 0;                  // how many there were
};

}  // namespace prf_core
