// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform_sim/frame_state.hpp"

namespace platform_sim {

/// Amplitudes and rates of one preset of the deck's motion.
struct PlatformMotionParams {
  double sway_amplitude = 0.0;   ///< m, along y
  double sway_rate = 0.0;        ///< rad/s
  double pitch_amplitude = 0.0;  ///< rad, commanded
  double pitch_rate = 0.0;       ///< rad/s
  double pitch_phase = 0.0;      ///< rad, lead of the pitch command over the sway at time 0
};

/// Motion of the deck in world, in closed form. World: the platform frame at rest.
///
///   sway(t)   = r(t) A_s sin(w_s (t + t0)),                    r: raised cosine 0 -> 1 in 2 s
///   command(t)= r(t) A_p sin(w_p (t + t0) + p),   tau dpitch/dt + pitch = command,  pitch(0) = 0
///
/// The deck turns about an axis parallel to y, below and behind its centre; positive pitch lowers
/// the front. At t <= 0 it is at rest. t0 is 0 without a seed, else drawn from it.
class PlatformMotion {
 public:
  /// `preset` is one of preset_names(), else std::invalid_argument which lists them.
  explicit PlatformMotion(const std::string& preset,
                          std::optional<std::uint64_t> seed = std::nullopt);

  [[nodiscard]] static const std::vector<std::string>& preset_names();

  [[nodiscard]] FrameState deck(double time) const;
  [[nodiscard]] double sway(double time) const;
  [[nodiscard]] double sway_velocity(double time) const;
  [[nodiscard]] double pitch(double time) const;
  [[nodiscard]] double pitch_velocity(double time) const;

 private:
  PlatformMotionParams params_;
  double start_phase_time_ = 0.0;  // t0, s
};

}  // namespace platform_sim
