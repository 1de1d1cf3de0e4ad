// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform_sim/play_pattern.hpp"
#include "platform_sim/recorded_motion.hpp"

namespace platform_sim {

/// Axes of the deck's motion: along x, y, z, m, and about x, y, z, rad.
inline constexpr std::array<const char*, 6> kAxisNames{"surge", "sway",  "heave",
                                                       "roll",  "pitch", "yaw"};
enum class Axis { kSurge, kSway, kHeave, kRoll, kPitch, kYaw };

struct Sine {
  double amplitude = 0.0;  ///< m or rad
  double rate = 0.0;       ///< rad/s
  double phase = 0.0;      ///< rad
};

/// Command of one axis, a sum of sines, and the first-order lag, s, with which the deck follows it.
struct AxisProfile {
  std::vector<Sine> sines;
  double lag = 0.0;
};

/// How a deck moves: sines per axis, played by a pattern if there is one, or a recording with
/// columns named as axes. A robot stands on its legs unless the deck carries its base.
///
/// Bounds, chosen by hand with room above 10 deg and 50 mm, to which the published commands of the
/// treadmill are scaled: 0.1 m, 0.5 m/s, 2.5 m/s2; 0.18 rad, 0.7 rad/s, 3 rad/s2. If the base is
/// carried: 1 m, 10 m/s, 150 m/s2; 0.5 rad, 5 rad/s, 50 rad/s2. What counts is
/// what the sines reach together in 720 s, not the sum of their amplitudes.
struct PlatformProfile {
  std::array<AxisProfile, 6> axes;
  std::optional<PlayPattern> pattern;
  std::optional<RecordedMotion> recording;
  bool carries_base = false;

  /// Throws std::invalid_argument with axis, value and bound.
  void validate() const;
};

/// none, and the files of config/profiles by their names, which are built in.
[[nodiscard]] const std::vector<std::string>& preset_names();

/// A preset by its name; FAMILY:LEVEL, where the seed draws the sea's waves, the bursts and the
/// stops; or a profile from a file that ends in .yaml (as those of config/profiles) or .csv (see
/// RecordedMotion). Validated. Throws std::invalid_argument that says what is wrong.
[[nodiscard]] PlatformProfile find_profile(const std::string& motion, std::uint64_t seed = 0);

}  // namespace platform_sim
