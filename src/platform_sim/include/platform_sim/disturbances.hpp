// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "platform_sim/cart_push.hpp"
#include "platform_sim/frame_state.hpp"

namespace platform_sim {

class Draws;

/// What is done to a trial's world from outside: "NAME:LEVEL[@TIME]", several parted by commas or
/// plus signs. What is not said is drawn from the seed: time 3..9 s, direction, side, duration.
///
///   push, push_hand, push_body   LEVEL N for 0.2..0.5 s on the hand or the body (push: either),
///   level
///                                or up to 30 degrees up or down, in any direction
///   stumble                      a foot, any one, is drawn aside for 0.2 s with LEVEL times what
///                                friction holds at a quarter of the robot's weight: above 1 it
///                                slips
///   cart, cart_toward            the cart is pushed LEVEL m, aside to either side within 30
///   degrees of
///                                the world's y axis or, _toward, within 30 degrees of -x, at most
///                                0.75..1.5 m/s per m of its way
///
/// Forces rise and fall as sin^2.
class Disturbances {
 public:
  enum class Unit { kNewton, kFootHold };
  struct Force {
    std::string word;  ///< as asked for, with its time
    std::string link;
    double begin = 0.0, duration = 0.0;              ///< s
    Eigen::Vector3d peak = Eigen::Vector3d::Zero();  ///< in world, in `unit`
    Unit unit = Unit::kNewton;
  };

  /// None.
  Disturbances() = default;
  /// Throws std::invalid_argument that says what is valid.
  Disturbances(const std::string& text, std::uint64_t seed);

  struct Kind {
    const char* name;
    double highest;  ///< level; the lowest is 0
  };
  [[nodiscard]] static const std::vector<Kind>& kinds();

  [[nodiscard]] const std::vector<Force>& forces() const { return forces_; }
  /// Share of the peak at a time, 0 outside of it.
  [[nodiscard]] static double share(const Force& force, double time);
  [[nodiscard]] bool moves_cart() const { return !pushes_.empty(); }
  /// All pushes of the cart together; only with moves_cart().
  [[nodiscard]] FrameState cart(double time) const;

  struct Acting {
    std::string word, what;
  };
  /// What acts at a time, and what it is, in words.
  [[nodiscard]] std::vector<Acting> acting(double time) const;

 private:
  struct Push {
    std::string word;
    CartPush path;
  };

  void add_force(const std::string& name, const std::string& word, double level, double begin,
                 Draws& draws);
  void add_push(const std::string& name, const std::string& word, double level, double begin,
                Draws& draws);

  std::vector<Force> forces_;
  std::vector<Push> pushes_;
};

}  // namespace platform_sim
