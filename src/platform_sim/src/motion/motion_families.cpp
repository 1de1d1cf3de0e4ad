// SPDX-License-Identifier: BSD-3-Clause
#include "motion_families.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <prf_core/require.hpp>
#include <utility>

#include "draws.hpp"
#include "named_level.hpp"
#include "profile_reach.hpp"

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity = 9.81;     // m/s2
constexpr double kSeaPeriod = 80.0;   // s
constexpr double kPeakRate = 2.0;     // rad/s
constexpr double kSlowestWave = 1.2;  // rad/s
constexpr double kFastestWave = 4.2;  // rad/s
constexpr std::uint64_t kSeaStream = 0x7365610000000000;
constexpr double kCalmShare = 1.0 / 3.0;  // of heavy's amplitude at level 1, between bursts
constexpr double kStopPitch = 0.7;        // share of heavy's

// How an axis answers: natural rate, rad/s, damping ratio, and what the waves do to it.
struct Response {
  double rate, damping;
};
// A stiff hull: heave and pitch are damped by the waves that they make, roll hardly.
constexpr std::array<Response, 6> kResponses{
    {{6.0, 0.7}, {6.0, 0.7}, {3.0, 0.4}, {2.4, 0.15}, {3.2, 0.35}, {4.0, 0.6}}};

double jonswap(double rate) {
  const double width = rate <= kPeakRate ? 0.07 : 0.09;
  const double off = (rate - kPeakRate) / (width * kPeakRate);
  return std::pow(rate, -5.0) * std::exp(-1.25 * std::pow(kPeakRate / rate, 4.0)) *
         std::pow(3.3, std::exp(-0.5 * off * off));
}

std::complex<double> drive_of(std::size_t axis, double rate, double direction) {
  const std::complex<double> i(0.0, 1.0);
  const double slope = rate * rate / kGravity;
  switch (static_cast<Axis>(axis)) {
    case Axis::kSurge:
      return i * std::cos(direction);
    case Axis::kSway:
      return i * std::sin(direction);
    case Axis::kHeave:
      return 1.0;
    case Axis::kRoll:
      return i * slope * std::sin(direction);
    case Axis::kPitch:
      return i * slope * std::cos(direction);
    case Axis::kYaw:
      return 0.3 * slope * std::sin(direction) * std::cos(direction);
  }
  return 0.0;
}

void scale(AxisProfile& axis, double factor) {
  for (Sine& sine : axis.sines) sine.amplitude *= factor;
}

// The whole motion, lag included, as a film that is played larger and faster.
PlatformProfile at_level(PlatformProfile profile, double level) {
  const double root = std::sqrt(level);
  for (AxisProfile& axis : profile.axes) {
    scale(axis, root);
    for (Sine& sine : axis.sines) sine.rate *= root;
    if (axis.lag > 0.0 && root > 0.0) axis.lag /= root;
  }
  return profile;
}

// The same steady motion, without the lag's transient.
PlatformProfile without_lag(PlatformProfile profile) {
  for (AxisProfile& axis : profile.axes) {
    for (Sine& sine : axis.sines) {
      const double delay = std::atan(sine.rate * axis.lag);
      sine.amplitude *= std::cos(delay);
      sine.phase -= delay;
    }
    axis.lag = 0.0;
  }
  return profile;
}

double share_of(const Reach& reach, const Reach& most) {
  return std::max({reach.value / most.value, reach.velocity / most.velocity,
                   reach.acceleration / most.acceleration});
}

AxisProfile& axis_of(PlatformProfile& profile, Axis axis) {
  return profile.axes[static_cast<std::size_t>(axis)];
}

}  // namespace

const std::vector<std::string>& family_names() {
  static const std::vector<std::string> names{"heavy", "sea", "bursts", "stop"};
  return names;
}

PlatformProfile sea_profile(const PlatformProfile& heavy, std::uint64_t seed) {
  Draws draws(seed, kSeaStream);
  const double direction = draws.uniform(0.0, 2.0 * kPi);
  PlatformProfile sea;
  const double step = 2.0 * kPi / kSeaPeriod;
  for (int n = static_cast<int>(std::ceil(kSlowestWave / step)); n * step < kFastestWave; ++n) {
    const double rate = n * step;
    const double phase = draws.uniform(0.0, 2.0 * kPi);
    for (std::size_t axis = 0; axis < sea.axes.size(); ++axis) {
      const auto [natural, damping] = kResponses[axis];
      const double ratio = rate / natural;
      const std::complex<double> response =
          drive_of(axis, rate, direction) /
          std::complex<double>(1.0 - ratio * ratio, 2.0 * damping * ratio);
      sea.axes[axis].sines.push_back(
          {std::sqrt(jonswap(rate)) * std::abs(response), rate, phase + std::arg(response)});
    }
  }
  for (const auto& [first, like] : {std::pair{0u, Axis::kSway}, std::pair{3u, Axis::kPitch}}) {
    const Reach most = reach_of(heavy.axes[static_cast<std::size_t>(like)]);
    double share = 0.0;
    for (std::size_t axis = first; axis < first + 3; ++axis)
      share = std::max(share, share_of(sampled_reach_of(sea.axes[axis]), most));
    for (std::size_t axis = first; axis < first + 3; ++axis) scale(sea.axes[axis], 1.0 / share);
  }
  return sea;
}

std::optional<PlatformProfile> family_profile(const std::string& text, const PlatformProfile& heavy,
                                              std::uint64_t seed) {
  const auto& names = family_names();
  const std::string family = text.substr(0, text.find(':'));
  if (std::find(names.begin(), names.end(), family) == names.end()) return std::nullopt;
  const std::optional<NamedLevel> named = named_level_of(text);
  if (!named || named->time) return std::nullopt;
  const double level = named->level;
  prf_core::require_between("level of " + family, level, 0.0, kHighestLevel);
  if (family == "heavy") return at_level(heavy, level);
  if (family == "sea") return at_level(sea_profile(heavy, seed), level);
  PlatformProfile profile = at_level(without_lag(heavy), level);
  if (family == "bursts") {
    const double calm = level > 0.0 ? std::min(1.0, kCalmShare / std::sqrt(level)) : 1.0;
    profile.pattern = PlayPattern::bursts(calm, seed);
  } else {
    scale(axis_of(profile, Axis::kPitch), kStopPitch);
    profile.pattern = PlayPattern::stops(seed);
  }
  return profile;
}

}  // namespace platform_sim
