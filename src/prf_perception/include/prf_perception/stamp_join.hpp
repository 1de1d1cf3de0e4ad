// SPDX-License-Identifier: BSD-3-Clause
// Joins a first stream with a second by equal stamps, whatever the order in which they arrive.
//
// Each accepted message of the first stream comes out exactly once, in order, when the oldest one
// is decided:
//
//   the second stream's message of its stamp has come          -> joined with it
//   two later ones have come, at most kNear later              -> alone: it was lost; one proves
//                                                                 nothing, its stamp may be wrong
//   the first stream has gone on by more than max_wait         -> alone
//   more than kMost of the first stream wait                   -> alone
//
// Unlike prf_core/stream_joiner.hpp it waits for the second stream at every message, also when the
// second stream has just been silent: an image is of no use without its camera_info.
//
// The first stream alone has the clock (prf_core/clock_monitor.hpp), and only its jumps begin a new
// run. What waited from the run before is dropped then.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <prf_core/clock_monitor.hpp>
#include <prf_core/time.hpp>
#include <utility>

namespace prf_perception {

template <typename First, typename Second>
class StampJoin {
 public:
  static constexpr prf_core::Duration kNear = std::chrono::seconds(1);

  struct Joined {
    First first;
    std::optional<Second> second;
  };

  explicit StampJoin(prf_core::Duration max_wait) : max_wait_(max_wait) {}

  // Keeps the message if prf_core::is_accepted() its order.
  prf_core::StampOrder push_first(prf_core::Stamp stamp, First value) {
    const prf_core::StampOrder order = clock_.observe(stamp);
    if (order == prf_core::StampOrder::kBackwardJump) {
      firsts_.clear();
      drop_seconds([stamp](prf_core::Stamp of_old_run) { return of_old_run - stamp > kNear; });
    }
    if (prf_core::is_accepted(order)) firsts_.emplace_back(stamp, std::move(value));
    return order;
  }

  // False, and without effect, when there is one of this stamp already.
  bool push_second(prf_core::Stamp stamp, Second value) {
    if (find(stamp) != seconds_.end()) return false;
    seconds_.emplace_back(stamp, std::move(value));
    if (seconds_.size() > kMost) seconds_.pop_front();
    return true;
  }

  // The oldest message of the first stream when it is decided; else nullopt.
  [[nodiscard]] std::optional<Joined> pop() {
    if (firsts_.empty()) return std::nullopt;
    const prf_core::Stamp stamp = firsts_.front().first;
    std::optional<Second> match;
    if (const auto found = find(stamp); found != seconds_.end()) {
      match = found->second;
    } else if (later_seconds(stamp) < 2 && *clock_.newest() - stamp <= max_wait_ &&
               firsts_.size() <= kMost) {
      return std::nullopt;
    }
    // Those of a run that begins just now are farther back.
    drop_seconds([stamp](prf_core::Stamp past) { return past < stamp && stamp - past <= kNear; });
    Joined joined{std::move(firsts_.front().second), std::move(match)};
    firsts_.pop_front();
    return joined;
  }

 private:
  static constexpr std::size_t kMost = 100;  // of each stream

  using Seconds = std::deque<std::pair<prf_core::Stamp, Second>>;  // in order of arrival

  typename Seconds::iterator find(prf_core::Stamp stamp) {
    return std::find_if(seconds_.begin(), seconds_.end(),
                        [stamp](const auto& entry) { return entry.first == stamp; });
  }

  [[nodiscard]] std::ptrdiff_t later_seconds(prf_core::Stamp stamp) const {
    return std::count_if(seconds_.begin(), seconds_.end(), [stamp](const auto& entry) {
      return entry.first > stamp && entry.first - stamp <= kNear;
    });
  }

  template <typename Condition>
  void drop_seconds(Condition condition) {
    seconds_.erase(
        std::remove_if(seconds_.begin(), seconds_.end(),
                       [&condition](const auto& entry) { return condition(entry.first); }),
        seconds_.end());
  }

  prf_core::Duration max_wait_;
  prf_core::ClockMonitor clock_;
  std::deque<std::pair<prf_core::Stamp, First>> firsts_;
  Seconds seconds_;
};

}  // namespace prf_perception
