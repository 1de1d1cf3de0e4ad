// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "attitude_reference.hpp"
#include "feet.hpp"
#include "virtual_model.hpp"

namespace v60_gait {

/// Trots in place. Feet on the ground carry the body (VirtualModel) over the place it has come to:
/// the way over the deck is summed from the legs' motion, the operator's stick moves the aim, and
/// so does every landing, because no foot comes down just where it should. Feet in the air are
/// drawn by springs along an arc to where they balance the body's velocity (Raibert 1986). The
/// trot is faster when the body is pushed about. Before time 0 all feet stay down and the body
/// moves over them until they balance it; while it trots the controller learns where they do.
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
  double turning_ = 0.0;                                // rad/s, roll and pitch, smoothed
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  // m/s, of the body over the deck
  Eigen::Vector2d way_ = Eigen::Vector2d::Zero();       // m, from the aim to the body
  Eigen::Vector2d balance_;                             // m, mean of the feet at rest, in base_link
  double yaw_ = 0.0;                                    // rad, aim
  Eigen::Vector3d placing_error_ = Eigen::Vector3d::Zero();  // m, m, rad; pair in the air
  std::array<Eigen::Vector3d, 4> lift_off_;
  double last_time_ = 0.0;
  bool has_time_ = false;
};

}  // namespace v60_gait
