// SPDX-License-Identifier: BSD-3-Clause
// Parts from which a node joins streams of stamped data, so that its results do not depend on how
// the messages of different streams interleave; each stream keeps its own order.
//
//   StampedQueue     messages of one stream with rising stamps
//   SilenceMonitor   when to stop waiting for a stream, by data time
//   StreamJoiner     joins each message of one stream with the message of another that has the same
//                    stamp (stream_joiner.hpp)
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include "prf_core/clock_monitor.hpp"
#include "prf_core/require.hpp"

namespace prf_core {

// Messages by stamp, oldest first, with the clock of their stream. Beyond `capacity` the oldest
// are dropped; no return value tells that.
//
//   order of a pushed stamp       effect
//   kNewer, kForwardJump          stored
//   kDuplicate, kOld, kFarAhead   not stored
//   kBackwardJump                 the messages stored before are dropped, the new one is stored
template <typename Message>
class StampedQueue {
 public:
  struct Item {
    Stamp stamp;
    Message message;
  };

  explicit StampedQueue(const ClockBounds& bounds = {}, std::size_t capacity = 1000)
      : clock_(bounds), capacity_(capacity) {}

  StampOrder push(Stamp stamp, Message message) {
    const StampOrder order = clock_.observe(stamp);
    if (order == StampOrder::kBackwardJump) items_.clear();
    if (is_accepted(order)) {
      items_.push_back({stamp, std::move(message)});
      if (items_.size() > capacity_) items_.pop_front();
    }
    return order;
  }

  // The oldest message when its stamp is at most `latest`.
  [[nodiscard]] std::optional<Item> pop_until(Stamp latest) {
    if (items_.empty() || items_.front().stamp > latest) return std::nullopt;
    Item item = std::move(items_.front());
    items_.pop_front();
    return item;
  }

  // Null when no message has exactly this stamp.
  [[nodiscard]] const Message* find(Stamp stamp) const {
    const auto found = std::lower_bound(items_.begin(), items_.end(), stamp, is_before);
    return found == items_.end() || found->stamp != stamp ? nullptr : &found->message;
  }

  void drop_before(Stamp stamp) {
    items_.erase(items_.begin(), std::lower_bound(items_.begin(), items_.end(), stamp, is_before));
  }
  void drop_after(Stamp stamp) {
    while (!items_.empty() && items_.back().stamp > stamp) items_.pop_back();
  }
  void clear() { items_.clear(); }

  [[nodiscard]] const std::deque<Item>& items() const { return items_; }
  [[nodiscard]] const ClockMonitor& clock() const { return clock_; }
  [[nodiscard]] ClockMonitor& clock() { return clock_; }

 private:
  static bool is_before(const Item& item, Stamp stamp) { return item.stamp < stamp; }

  ClockMonitor clock_;
  std::size_t capacity_;
  std::deque<Item> items_;
};

// A message of another stream waits for this one. The stream is silent once the other stream has
// gone on by more than `max_wait` since the stamp of the waiting message. A silent stream is not
// waited for until it is heard again.
class SilenceMonitor {
 public:
  // max_wait > 0; Duration::max() waits without end.
  explicit SilenceMonitor(Duration max_wait) : max_wait_(max_wait) {
    require(max_wait > Duration{0}, "max_wait", to_seconds(max_wait), "> 0 s");
  }

  void heard() { silent_ = false; }

  // Whether a message stamped `waiting` need not wait any longer, now that its own stream has come
  // to `newest`. When it has waited too long, the stream becomes silent by this call.
  [[nodiscard]] bool gives_up(Stamp waiting, Stamp newest) {
    silent_ = silent_ || newest - waiting > max_wait_;
    return silent_;
  }

  [[nodiscard]] bool is_silent() const { return silent_; }

 private:
  Duration max_wait_;
  bool silent_ = false;
};

}  // namespace prf_core
