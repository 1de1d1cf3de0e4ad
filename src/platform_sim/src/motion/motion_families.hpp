// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform_sim/platform_profile.hpp"

namespace platform_sim {

/// Motions with a level: amplitudes go with the square root of it, and rates too, so that
/// velocities go with the level. 1 is the paper's heavy motion, kHighestLevel is as far as the
/// platform goes.
inline constexpr double kHighestLevel = 2.75;

/// heavy: as the preset. sea: a seaway, see sea_profile(). bursts: light motion at a third of its
/// amplitude with seconds of heavy:LEVEL. stop: heavy:LEVEL with 0.7 of its pitch, stopped and
/// started again (PlayPattern).
[[nodiscard]] const std::vector<std::string>& family_names();

/// The profile of "FAMILY:LEVEL", nothing if the text is of no family. Throws std::invalid_argument
/// for a level that is none.
[[nodiscard]] std::optional<PlatformProfile> family_profile(const std::string& text,
                                                            const PlatformProfile& heavy,
                                                            std::uint64_t seed);

/// The deck in a seaway of the JONSWAP spectrum (Hasselmann et al. 1973),
///   S(w) ~ w^-5 exp(-1.25 (wp/w)^4) 3.3^exp(-(w - wp)^2 / (2 s^2 wp^2)),  wp 2 rad/s,
/// s 0.07 below and 0.09 above wp, cut to 1.2..4.2 rad/s: a sea at the scale of the platform. Each
/// axis responds as a damped oscillator,
///   q / drive = 1 / (1 - (w/wn)^2 + 2 i d w/wn),
/// to the water's motion (surge and sway a quarter of a period behind heave) or to the wave's slope
/// w^2/g, by the waves' direction. Direction and the phases of the waves come from the seed. The
/// same waves come again after 80 s (at a level, after 80 s / sqrt(level)). No axis reaches
/// further, faster or with more acceleration than sway (linear) and pitch (angular) of `heavy`, and
/// one does in one of the three.
[[nodiscard]] PlatformProfile sea_profile(const PlatformProfile& heavy, std::uint64_t seed);

}  // namespace platform_sim
