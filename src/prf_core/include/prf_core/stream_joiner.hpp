// SPDX-License-Identifier: BSD-3-Clause
// Joins each message of a primary stream with the message of a secondary stream whose stamp equals
// the primary's key. The key is the primary's own stamp (a control tick and its set-point), or a
// stamp that the primary names (an ExecutionProgress message and the forecast that it used).
//
// Primaries come out in the order in which they were pushed, each once. A primary is decided when
// no later message can change what it is joined with. The oldest one is decided when
//
//   a secondary with stamp = key has come                       -> joined with it
//   a later secondary has come                                  -> alone: it was never sent
//   the primary stream has gone on by more than max_wait        -> alone: the secondary is silent,
//                                                                  and not waited for until one
//                                                                  comes again
//   more than `capacity` primaries wait                         -> alone
//
// The results do not depend on the interleaving as long as each secondary comes before the primary
// stream is more than max_wait past the primary that it belongs to, and no queue is full. Beyond
// `capacity` the oldest secondary is dropped; no return value tells that.
//
// A run is the data between two backward jumps of a stream. A jump of the primary stream begins a
// new run of the joiner; the streams may jump in either order:
//
//   the primary jumps first      waiting primaries and stored secondaries are dropped; secondaries
//                                that still continue the old run are dropped until they jump too
//   the secondary jumps first    stored secondaries are dropped; new ones are kept for the primary
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include "prf_core/stream.hpp"

namespace prf_core {

struct JoinParams {
  Duration max_wait = Duration::max();  // of data time, > 0; the default: no end
  Duration primary_jump =
      std::chrono::seconds(1);  // a larger step back of the primaries is a new run
  Duration secondary_jump = std::chrono::seconds(1);  // the same for the secondaries
  std::size_t capacity = 1000;                        // of messages, for each stream
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
      : params_(params),
        clock_({params.primary_jump}),
        secondaries_({params.secondary_jump}, params.capacity),
        silence_(params.max_wait) {}

  // Tells the joiner that the primary stream has come to `stamp`. To be called for a primary that
  // is not to be joined: it lets time pass, and a backward jump of it begins a new run.
  StampOrder advance(Stamp stamp) {
    const StampOrder order = clock_.observe(stamp);
    if (order != StampOrder::kBackwardJump) return order;
    waiting_.clear();
    decided_.reset();
    silence_.heard();
    new_run_ = true;
    const bool both_jumped = ahead_ == Ahead::kSecondary;
    if (!both_jumped) secondaries_.clear();
    ahead_ = both_jumped ? Ahead::kNone : Ahead::kPrimary;
    return order;
  }

  // Advances and queues the message, also a duplicate or an old one. A caller that does not want
  // these calls advance() first and looks at its result; the push then returns kDuplicate.
  StampOrder push_primary(Stamp stamp, Primary message) {
    return push_primary(stamp, stamp, std::move(message));
  }
  StampOrder push_primary(Stamp stamp, Stamp key, Primary message) {
    const StampOrder order = advance(stamp);
    waiting_.push_back({key, {stamp, std::move(message), std::nullopt, new_run_}});
    new_run_ = false;
    return order;
  }

  // Returns kOld or kDuplicate for a message that comes too late to be joined, that has a stamp
  // twice, or that is of the old run. Returns kBackwardJump for the first secondary of a run when
  // secondaries of the run before had come, whichever stream jumped first. Never kFarAhead.
  StampOrder push_secondary(Stamp stamp, Secondary message) {
    const bool jumps = secondaries_.clock().classify(stamp) == StampOrder::kBackwardJump;
    const bool follows =
        ahead_ == Ahead::kPrimary && (jumps || stamp - *clock_.newest() <= params_.secondary_jump);
    if (ahead_ == Ahead::kPrimary && !follows) return StampOrder::kOld;
    const bool was_heard = secondaries_.clock().newest().has_value();
    silence_.heard();
    if (follows) {
      secondaries_.clock().restart();
      ahead_ = Ahead::kNone;
    } else if (jumps) {
      const bool primary_follows = !clock_.newest() || stamp < *clock_.newest();
      ahead_ = primary_follows ? Ahead::kSecondary : Ahead::kNone;
    }
    const bool late = ahead_ == Ahead::kNone && decided_ && stamp <= *decided_;
    const StampOrder order = secondaries_.push(stamp, std::move(message));
    if (follows && was_heard) return StampOrder::kBackwardJump;
    return late && order == StampOrder::kNewer ? StampOrder::kOld : order;
  }

  // Takes out the oldest primary when it is decided; none: nothing is decided.
  [[nodiscard]] std::optional<Joined> pop() {
    if (waiting_.empty()) return std::nullopt;
    auto& [key, joined] = waiting_.front();
    if (const Secondary* match = secondaries_.find(key)) {
      joined.secondary = *match;
      ahead_ = Ahead::kNone;
    } else if (!is_past(key) && !gives_up(joined.stamp)) {
      return std::nullopt;
    }
    decided_ = key;
    if (ahead_ == Ahead::kNone) secondaries_.drop_before(key);
    std::optional<Joined> result = std::move(joined);
    waiting_.pop_front();
    return result;
  }

  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  [[nodiscard]] bool is_silent() const { return silence_.is_silent(); }

 private:
  // Whose clock has jumped back while the other's has not yet.
  enum class Ahead { kNone, kPrimary, kSecondary };

  struct Waiting {
    Stamp key;
    Joined joined;
  };

  [[nodiscard]] bool is_past(Stamp key) const {
    const auto newest = secondaries_.clock().newest();
    return ahead_ != Ahead::kPrimary && newest && *newest > key;
  }

  [[nodiscard]] bool gives_up(Stamp waiting) {
    return silence_.gives_up(waiting, *clock_.newest()) || waiting_.size() > params_.capacity;
  }

  JoinParams params_;
  ClockMonitor clock_;  // of the primary stream
  std::deque<Waiting> waiting_;
  StampedQueue<Secondary> secondaries_;
  SilenceMonitor silence_;
  std::optional<Stamp> decided_;  // newest key of this run that was decided
  Ahead ahead_ = Ahead::kNone;
  bool new_run_ = false;  // the next primary pushed is the first of a new run
};

}  // namespace prf_core
