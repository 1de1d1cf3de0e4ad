// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "platform_sim/frame_state.hpp"

namespace platform_sim {

/// A hand pushes the cart aside, once, along a straight line over the floor. It speeds up and slows
/// down as a reaching hand does, with the least jerk (Flash and Hogan 1985):
///   s(u) = distance (10 u^3 - 15 u^4 + 6 u^5),  u = (t - start) / duration in 0..1.
/// The cart's frame is the world's until the push and does not turn.
class CartPush {
 public:
  struct Params {
    double start = 6.0;     ///< s
    double duration = 2.0;  ///< s
    double distance = 0.2;  ///< m
    double heading = 0.0;   ///< rad from world x
  };

  /// Throws std::invalid_argument with name, value and bound.
  explicit CartPush(const Params& params);

  /// Start 2..5 s, duration 2..3 s, distance 0.10..0.15 m, to either side within 20 degrees of the
  /// world's y axis. The distances are chosen so that the tag stays in view of a hand that waits
  /// 0.45 m in front of it.
  [[nodiscard]] static Params draw(std::uint64_t seed);

  [[nodiscard]] FrameState cart(double time) const;
  [[nodiscard]] const Params& params() const { return params_; }

 private:
  Params params_;
};

}  // namespace platform_sim
