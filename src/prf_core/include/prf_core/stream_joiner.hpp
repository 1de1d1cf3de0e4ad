// SPDX-License-Identifier: BSD-3-Clause
// Joins each message of a primary stream with the message of a secondary stream whose stamp equals
// the primary's key. The key is the primary's own stamp (a control tick and its set-point), or a
// stamp that the primary names (an ExecutionProgress message and the forecast that it used).
//
// Primaries come out in the order in which they were pushed, each once. A primary is decided when
// no later message can change what it is joined with. The oldest one is decided when
//
//   a secondary with stamp = key has come                       -> joined with it
//   the latest secondary is a later one, at most max_lead ahead
//   of the newest primary                                       -> alone: it was never sent
//   the primary stream has gone on by more than max_wait        -> alone: the secondary is silent,
//                                                                  and not waited for until one
//                                                                  comes again
//   more than `capacity` primaries wait                         -> alone
//   its key is far ahead of its stamp                           -> alone
//
// The results do not depend on the interleaving as long as each secondary comes before the primary
// stream is more than max_wait past the primary that it belongs to, and no queue is full. Beyond
// `capacity` the oldest secondary is dropped; no return value tells that.
//
// The primary stream alone has the clock (clock_monitor.hpp). When it jumps back a new run begins:
// waiting primaries and stored secondaries are dropped. A secondary that lies too far before or
// beyond the newest primary is set aside until the primaries come near it. It is dropped when the
// next secondary is in range, for then its stamp was wrong. So the streams may jump in either
// order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "prf_core/stream.hpp"

namespace prf_core {

struct JoinParams {
  Duration max_wait = Duration::max();  // of data time, > 0; the default: no end
  ClockBounds clock = {};               // of the primaries; its bounds hold for secondaries, too
  std::size_t capacity = 1000;          // of messages, for each stream
  // A secondary farther ahead than this may be a wrong stamp, so that it proves nothing yet.
  Duration max_lead = std::chrono::milliseconds(100);
};

template <typename Primary, typename Secondary>
class StreamJoiner {
 public:
  struct Joined {
    Stamp stamp;
    Primary primary;
    std::optional<Secondary> secondary;
    bool new_run = false;  // the first of a run that began with a backward jump
  };

  explicit StreamJoiner(const JoinParams& params)
      : params_(params), clock_(params.clock), silence_(params.max_wait) {}

  // Tells the joiner that the primary stream has come to `stamp`. To be called for a primary that
  // is not to be joined: it lets time pass, and a backward jump of it begins a new run.
  StampOrder advance(Stamp stamp) {
    const bool is_first = !clock_.newest();
    const StampOrder order = clock_.observe(stamp);
    if (is_first) std::swap(aside_, secondaries_);
    if (order == StampOrder::kBackwardJump) {
      waiting_.clear();
      secondaries_.clear();
      decided_.reset();
      last_secondary_.reset();
      silence_.heard();
      new_run_ = true;
    }
    if (is_accepted(order)) take_back();
    if (order == StampOrder::kBackwardJump) {
      aside_.clear();
      secondary_follows_ = !secondaries_.empty();
    }
    return order;
  }

  // Advances and queues the message, also a duplicate; one that is old or far ahead is dropped. A
  // caller that does not want duplicates calls advance() first and looks at its result; the push
  // then returns kDuplicate.
  StampOrder push_primary(Stamp stamp, Primary message) {
    return push_primary(stamp, stamp, std::move(message));
  }
  StampOrder push_primary(Stamp stamp, Stamp key, Primary message) {
    const StampOrder order = advance(stamp);
    if (!is_accepted(order) && order != StampOrder::kDuplicate) return order;
    waiting_.push_back({key, {stamp, std::move(message), std::nullopt, new_run_}});
    new_run_ = false;
    return order;
  }

  // Returns kNewer for a message that can still be joined, kDuplicate for the second one of a
  // stamp, kOld for one that comes too late or lies more than the bound before the newest primary,
  // kFarAhead for one that lies more than the bound beyond it.
  StampOrder push_secondary(Stamp stamp, Secondary message) {
    if (clock_.jumps_back(stamp) || clock_.jumps_ahead(stamp)) {
      const bool back = clock_.jumps_back(stamp);
      if (back || secondary_follows_) store(aside_, stamp, std::move(message));
      return back ? StampOrder::kOld : StampOrder::kFarAhead;
    }
    aside_.clear();
    secondary_follows_ = true;
    silence_.heard();
    if (!decided_ || stamp >= *decided_) last_secondary_ = stamp;
    if (secondaries_.count(stamp) > 0) return StampOrder::kDuplicate;
    if (decided_ && stamp <= *decided_) return StampOrder::kOld;
    store(secondaries_, stamp, std::move(message));
    return StampOrder::kNewer;
  }

  // Takes out the oldest primary when it is decided; none: nothing is decided.
  [[nodiscard]] std::optional<Joined> pop() {
    if (waiting_.empty()) return std::nullopt;
    auto& [key, joined] = waiting_.front();
    if (const auto match = secondaries_.find(key); match != secondaries_.end()) {
      joined.secondary = match->second;
    } else if (!is_past(key) && !is_far_ahead(key, joined.stamp) && !gives_up(joined.stamp)) {
      return std::nullopt;
    }
    if (!is_far_ahead(key, joined.stamp)) decided_ = std::max(decided_.value_or(key), key);
    if (decided_) secondaries_.erase(secondaries_.begin(), secondaries_.lower_bound(*decided_));
    std::optional<Joined> result = std::move(joined);
    waiting_.pop_front();
    return result;
  }

  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  [[nodiscard]] bool is_silent() const { return silence_.is_silent(); }

 private:
  using Secondaries = std::map<Stamp, Secondary>;

  struct Waiting {
    Stamp key;
    Joined joined;
  };

  void store(Secondaries& secondaries, Stamp stamp, Secondary message) {
    secondaries.emplace(stamp, std::move(message));
    while (secondaries.size() > params_.capacity) secondaries.erase(secondaries.begin());
  }

  // Of the secondaries that were set aside, those that are in range now.
  void take_back() {
    for (auto next = aside_.begin(); next != aside_.end();) {
      const auto one = next++;
      const bool in_range = !clock_.jumps_back(one->first) && !clock_.jumps_ahead(one->first);
      if (!in_range) continue;
      last_secondary_ = one->first;
      secondaries_.insert(aside_.extract(one));
    }
  }

  [[nodiscard]] bool is_far_ahead(Stamp key, Stamp stamp) const {
    return key - stamp > params_.clock.far_ahead;
  }

  [[nodiscard]] bool is_past(Stamp key) const {
    if (decided_ && key <= *decided_) return true;
    return last_secondary_ && *last_secondary_ > key &&
           *last_secondary_ - *clock_.newest() <= params_.max_lead;
  }

  [[nodiscard]] bool gives_up(Stamp waiting) {
    return silence_.gives_up(waiting, *clock_.newest()) || waiting_.size() > params_.capacity;
  }

  JoinParams params_;
  ClockMonitor clock_;  // of the primary stream
  std::deque<Waiting> waiting_;
  Secondaries secondaries_;
  Secondaries aside_;  // out of range since the last one that was in range
  SilenceMonitor silence_;
  std::optional<Stamp> decided_;         // newest key of this run that was decided
  std::optional<Stamp> last_secondary_;  // the latest to arrive that is not older than that
  bool new_run_ = false;                 // the next primary pushed is the first of a new run
  bool secondary_follows_ = true;        // false: it may still send what is left of the run before
};

}  // namespace prf_core
