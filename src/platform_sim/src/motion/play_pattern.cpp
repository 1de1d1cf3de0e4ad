// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/play_pattern.hpp"

#include <algorithm>
#include <cmath>

#include "draws.hpp"

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLongest = 700.0;  // s, more than a trial lasts
constexpr std::uint64_t kBurstStream = 0x6275727374730000;
constexpr std::uint64_t kStopStream = 0x73746f7073000000;

}  // namespace

PlayPattern PlayPattern::bursts(double calm, std::uint64_t seed) {
  PlayPattern pattern(Kind::kBursts, calm, 1.5);
  Draws draws(seed, kBurstStream);
  for (double time = 0.0; time < kLongest; time = pattern.intervals_.back().end) {
    const double begin = time + draws.uniform(5.0, 9.0);
    pattern.integrals_.push_back(0.0);  // the place does not depend on it
    pattern.intervals_.push_back({begin, begin + draws.uniform(3.0, 5.0) + pattern.ease_});
  }
  return pattern;
}

PlayPattern PlayPattern::stops(std::uint64_t seed) {
  PlayPattern pattern(Kind::kStops, 0.0, 0.4);
  Draws draws(seed, kStopStream);
  double stood = 0.0;
  for (double time = 0.0; time < kLongest; time = pattern.intervals_.back().end) {
    const double begin = time + draws.uniform(4.0, 8.0);
    const double stand = draws.uniform(1.0, 3.0);
    pattern.integrals_.push_back(stood);
    pattern.intervals_.push_back({begin, begin + stand + 2.0 * pattern.ease_});
    stood += stand + pattern.ease_;
  }
  return pattern;
}

PlayPattern::Window PlayPattern::window(double time) const {
  const auto after =
      std::upper_bound(intervals_.begin(), intervals_.end(), time,
                       [](double t, const Interval& interval) { return t < interval.begin; });
  if (after == intervals_.begin()) return {0.0, 0.0, 0.0};
  const Interval& interval = *(after - 1);
  const double before = integrals_[static_cast<std::size_t>(after - 1 - intervals_.begin())];
  const double whole = interval.end - interval.begin - ease_;  // integral over the interval
  if (time >= interval.end) return {0.0, 0.0, before + whole};
  const double rising = time - interval.begin, falling = interval.end - time;
  const auto eased = [this](double u) {
    return Window{0.5 * (1.0 - std::cos(kPi * u / ease_)),
                  0.5 * kPi / ease_ * std::sin(kPi * u / ease_),
                  0.5 * u - 0.5 * ease_ / kPi * std::sin(kPi * u / ease_)};
  };
  if (rising < ease_) {
    const Window rise = eased(rising);
    return {rise.value, rise.rate, before + rise.integral};
  }
  if (falling < ease_) {
    const Window rest = eased(falling);
    return {rest.value, -rest.rate, before + whole - rest.integral};
  }
  return {1.0, 0.0, before + 0.5 * ease_ + rising - ease_};
}

PlayPattern::State PlayPattern::at(double time) const {
  const Window now = window(time);
  if (kind_ == Kind::kStops) return {1.0, 0.0, time - now.integral, 1.0 - now.value};
  return {calm_ + (1.0 - calm_) * now.value, (1.0 - calm_) * now.rate, time, 1.0};
}

}  // namespace platform_sim
