// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "platform_sim/frame_state.hpp"
#include "platform_sim/platform_profile.hpp"

namespace platform_sim {

/// Motion of the deck in world. World: the platform frame at rest. Each axis moves as follows, in
/// closed form:
///
///   command(t) = r(t) sum_i A_i sin(w_i (t + t0) + p_i),       r: raised cosine 0 -> 1 in 2 s
///   lag dq/dt + q = command,  q(0) = 0;                        q = command without a lag
///
/// or q(t) = r(t) recording(t). A profile with a PlayPattern plays q by it. The deck goes by
/// (surge, sway, heave) and turns by Rz(yaw) Ry(pitch) Rx(roll) about a point 0.16 m below and 0.1
/// m behind its centre; positive pitch lowers the front. At t <= 0 it is at rest. t0 is 0 without a
/// seed, else drawn from it within 0..20 s.
class PlatformMotion {
 public:
  /// Throws what find_profile() throws.
  explicit PlatformMotion(const std::string& motion,
                          std::optional<std::uint64_t> seed = std::nullopt);

  [[nodiscard]] FrameState deck(double time) const;
  /// Whether the deck carries the robot's base, which then does not stand on its legs.
  [[nodiscard]] bool carries_base() const { return profile_.carries_base; }

  struct AxisState {
    double value = 0.0;     ///< m or rad
    double velocity = 0.0;  ///< m/s or rad/s
  };
  [[nodiscard]] AxisState axis(Axis axis, double time) const;

 private:
  PlatformProfile profile_;
  double start_phase_time_ = 0.0;  // t0, s
};

}  // namespace platform_sim
