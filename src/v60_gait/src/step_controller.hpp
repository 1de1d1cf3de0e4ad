// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "attitude_reference.hpp"
#include "feet.hpp"
#include "virtual_model.hpp"

namespace v60_gait {

/// Trots in place. The feet on the ground hold the body at a desired place on the deck
/// (VirtualModel). The body's offset from it is integrated from the legs' motion; the operator's
/// joystick moves the desired place, and so does each landing by its placing error. Feet in the air
/// are drawn by springs along an arc to where they balance the body's velocity (Raibert 1986). The
/// cadence rises with the body's speed. Before time 0 all feet stay on the ground and the body
/// moves until it is balanced over them; while it trots, the point of balance is estimated.
class StepController : public LegController {
 public:
  /// `seed`: of the errors in placing the feet, and of which pair lifts first.
  StepController(const Stance& stance, const BodyModel& body, double friction, std::uint64_t seed);

  [[nodiscard]] LegVector torques(const LegObservation& observed) override;

 private:
  void advance(double time, double duration);
  [[nodiscard]] double phase_of(std::size_t leg) const;
  void estimate(const LegObservation& observation, const Feet& feet, double duration);
  [[nodiscard]] BodyError body_error(const LegObservation& observation, const Feet& feet) const;
  [[nodiscard]] Eigen::Vector3d landing_place(std::size_t leg) const;
  [[nodiscard]] Eigen::Vector3d swing_force(const Feet& feet, std::size_t leg) const;

  StartHeading heading_;
  Stance stance_;
  VirtualModel model_;
  SlopeEstimate slope_;
  AttitudeReference attitude_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
  double cycles_;                                       // since time 0
  double cadence_;                                      // 1/s
  double speed_ = 0.0;                                  // m/s, of the body over the deck, smoothed
  double angular_speed_ = 0.0;                          // rad/s, roll and pitch, smoothed
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  // m/s, of the body over the deck
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();    // m, from the desired place to the body
  Eigen::Vector2d balance_;                             // m, mean of the feet at rest, in base_link
  double yaw_ = 0.0;                                    // rad, desired
  Eigen::Vector3d placing_error_ = Eigen::Vector3d::Zero();  // m, m, rad; pair in the air
  std::array<Eigen::Vector3d, 4> lift_off_;
  double last_time_ = 0.0;
  bool has_time_ = false;
};

}  // namespace v60_gait
