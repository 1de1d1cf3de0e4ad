// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace platform_sim {

/// How a deck's motion q is played in time: amount(t) q(place(t)). Seconds of calm take turns with
/// seconds of something else, both drawn from the seed; between them a raised cosine w goes from 0
/// to 1 and back.
///
///   bursts:  amount = c + (1 - c) w,  place = t                 (calm c, then all of the motion)
///   stops:   amount = 1,              place = t - int_0^t w     (moving, then standing still)
class PlayPattern {
 public:
  /// `calm` is c of above, 0..1. Bursts last 3..5 s with 5..9 s of calm before each, and rise in
  /// 1.5 s.
  [[nodiscard]] static PlayPattern bursts(double calm, std::uint64_t seed);
  /// Stands still for 1..3 s after 4..8 s of motion; stops and starts within 0.4 s.
  [[nodiscard]] static PlayPattern stops(std::uint64_t seed);

  struct State {
    double amount = 1.0, amount_rate = 0.0;  ///< 1, 1/s
    double place = 0.0, speed = 1.0;         ///< s, 1
  };
  [[nodiscard]] State at(double time) const;

 private:
  enum class Kind { kBursts, kStops };
  struct Interval {
    double begin, end;  // s, of the rise's begin and of the fall's end
  };
  struct Window {
    double value, rate, integral;
  };

  PlayPattern(Kind kind, double calm, double ease) : kind_(kind), calm_(calm), ease_(ease) {}
  [[nodiscard]] Window window(double time) const;

  Kind kind_;
  double calm_;
  double ease_;                      // s
  std::vector<Interval> intervals_;  // rising, apart
  std::vector<double> integrals_;    // s, of the window up to each interval's begin
};

}  // namespace platform_sim
