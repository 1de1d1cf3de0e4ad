// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "ground_forces.hpp"
#include "platform_sim/leg_controller.hpp"
#include "stance.hpp"

namespace platform_sim {

/// Trots in place. Feet on the ground carry the body by virtual springs between its pose and the
/// pose half-way between level and the deck's slope over the feet; the forces come from
/// distribute_wrench() and act through -J^T f. Feet in the air are drawn by springs along an arc to
/// where they balance the body's velocity over the deck (Raibert 1986). The body's way over the
/// deck is summed from the legs' motion. Before time 0 all feet stay down.
class StepController : public LegController {
 public:
  StepController(const Stance& stance, const BodyModel& body, double friction);

  [[nodiscard]] LegVector torques(const LegObservation& observation) override;

 private:
  struct Feet {  // relative to the base's origin, in axes with z up
    std::array<Eigen::Vector3d, 4> positions;
    std::array<Eigen::Vector3d, 4> velocities;
    std::array<Eigen::Matrix3d, 4> jacobians;
    std::array<bool, 4> on_ground;
  };

  [[nodiscard]] Feet observe(const LegObservation& observation) const;
  void estimate_body(const Feet& feet, double time);
  void estimate_slope(const Feet& feet, double duration);
  [[nodiscard]] Wrench balance(const LegObservation& observation, const Feet& feet) const;
  void carry(const LegObservation& observation, const Feet& feet, LegVector& torques);
  void swing(const LegObservation& observation, const Feet& feet, std::size_t leg,
             LegVector& torques);

  Stance stance_;
  BodyModel body_;
  double friction_;
  Eigen::Vector3d body_way_ = Eigen::Vector3d::Zero();       // over the deck since the start
  Eigen::Vector3d body_velocity_ = Eigen::Vector3d::Zero();  // over the deck
  Eigen::Vector2d slope_ = Eigen::Vector2d::Zero();          // pitch and roll of the deck, rad
  std::array<Eigen::Vector3d, 4> lift_off_;
  std::array<Eigen::Vector3d, 4> forces_;  // last ones, where the next search starts
  double last_time_ = 0.0;
  bool has_time_ = false;
};

}  // namespace platform_sim
