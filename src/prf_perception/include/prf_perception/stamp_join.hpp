// SPDX-License-Identifier: BSD-3-Clause
// Joins two streams by equal stamps, whatever the order in which the streams arrive.
//
// Stamps within a stream must rise; this is not checked. Within a run every message of the first
// stream comes out exactly once, in order: with the message of the second stream of the same stamp,
// or alone once it is certain that none will come (the second stream is past that stamp), or when
// the first stream's newest stamp is more than `max_wait` later. Unlike prf_core/stream_joiner.hpp
// it waits for the second stream at every message, also when the second stream has just been
// silent: an image is of no use without its camera_info. A stamp more than kNewRun behind the
// newest of its stream starts a new run.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <prf_core/time.hpp>
#include <utility>

namespace prf_perception {

template <typename First, typename Second>
class StampJoin {
 public:
  static constexpr prf_core::Duration kNewRun = std::chrono::seconds(1);

  struct Joined {
    First first;
    std::optional<Second> second;
  };

  explicit StampJoin(prf_core::Duration max_wait) : max_wait_(max_wait) {}

  // Both return true when the stamp began a new run; what waited from the old one is dropped.
  bool push_first(prf_core::Stamp stamp, First value) {
    return push(firsts_, seconds_, stamp, value);
  }
  bool push_second(prf_core::Stamp stamp, Second value) {
    const bool new_run = push(seconds_, firsts_, stamp, value);
    if (seconds_.queue.size() > kMaxSeconds) seconds_.queue.pop_front();
    return new_run;
  }

  // The oldest message of the first stream when no later message can change what it is joined with;
  // else nullopt.
  [[nodiscard]] std::optional<Joined> pop() {
    if (firsts_.queue.empty()) return std::nullopt;
    const prf_core::Stamp stamp = firsts_.queue.front().first;
    auto& seconds = seconds_.queue;
    while (!seconds.empty() && seconds.front().first < stamp) seconds.pop_front();

    std::optional<Second> match;
    if (!seconds.empty() && seconds.front().first == stamp) {
      match = seconds.front().second;
    } else if (seconds.empty() && *firsts_.last - stamp <= max_wait_) {
      return std::nullopt;
    }
    Joined joined{std::move(firsts_.queue.front().second), std::move(match)};
    firsts_.queue.pop_front();
    return joined;
  }

 private:
  static constexpr std::size_t kMaxSeconds = 1000;

  template <typename T>
  struct Stream {
    std::deque<std::pair<prf_core::Stamp, T>> queue;
    std::optional<prf_core::Stamp> last;
  };

  template <typename Own, typename Other>
  static bool push(Stream<Own>& own, Stream<Other>& other, prf_core::Stamp stamp, Own& value) {
    const bool new_run = own.last && stamp < *own.last - kNewRun;
    if (new_run) {
      own.queue.clear();
      const auto of_old_run = [&](const auto& entry) { return entry.first > stamp + kNewRun; };
      other.queue.erase(std::remove_if(other.queue.begin(), other.queue.end(), of_old_run),
                        other.queue.end());
    }
    own.last = stamp;
    own.queue.emplace_back(stamp, std::move(value));
    return new_run;
  }

  prf_core::Duration max_wait_;
  Stream<First> firsts_;
  Stream<Second> seconds_;
};

}  // namespace prf_perception
