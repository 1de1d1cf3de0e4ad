// SPDX-License-Identifier: BSD-3-Clause
// Joins two streams by equal stamps, whatever the order in which the streams arrive.
//
// Stamps within a stream rise. Every message of the first stream gets exactly one answer, in
// order: the message of the second stream with the same stamp, or nothing once it is certain that
// none will come (the second stream is past that stamp), or after `patience` of the first stream.
// A stamp more than kNewRun behind the newest of its stream starts a new run.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace prf_perception {

template <typename First, typename Second>
class StampJoin {
 public:
  using Nanoseconds = std::int64_t;
  static constexpr Nanoseconds kNewRun = 1'000'000'000;

  struct Joined {
    First first;
    std::optional<Second> second;
  };

  explicit StampJoin(Nanoseconds patience) : patience_(patience) {}

  // Both return true when the stamp began a new run; what waited from the old one is dropped.
  bool push_first(Nanoseconds stamp, First value) { return push(firsts_, seconds_, stamp, value); }
  bool push_second(Nanoseconds stamp, Second value) {
    const bool new_run = push(seconds_, firsts_, stamp, value);
    if (seconds_.queue.size() > kMaxSeconds) seconds_.queue.pop_front();
    return new_run;
  }

  // The next answer, as long as there is one that no later message can change.
  [[nodiscard]] std::optional<Joined> pop() {
    if (firsts_.queue.empty()) return std::nullopt;
    const Nanoseconds stamp = firsts_.queue.front().first;
    auto& seconds = seconds_.queue;
    while (!seconds.empty() && seconds.front().first < stamp) seconds.pop_front();

    std::optional<Second> match;
    if (!seconds.empty() && seconds.front().first == stamp) {
      match = seconds.front().second;
    } else if (seconds.empty() && *firsts_.last - stamp <= patience_) {
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
    std::deque<std::pair<Nanoseconds, T>> queue;
    std::optional<Nanoseconds> last;
  };

  template <typename Own, typename Other>
  static bool push(Stream<Own>& own, Stream<Other>& other, Nanoseconds stamp, Own& value) {
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

  Nanoseconds patience_;
  Stream<First> firsts_;
  Stream<Second> seconds_;
};

}  // namespace prf_perception
