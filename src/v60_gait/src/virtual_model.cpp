// SPDX-License-Identifier: BSD-3-Clause
#include "virtual_model.hpp"

#include <vector>

#include "v60_gait/gravity.hpp"

namespace v60_gait {
namespace {

constexpr double kPlannedFriction = 0.8;  // of the true coefficient, a margin against slipping

}  // namespace

VirtualModel::VirtualModel(const Stance& stance, const BodyModel& body, double friction,
                           const VirtualSprings& springs)
    : stance_(stance), body_(body), friction_(friction), springs_(springs) {
  forces_.fill(Eigen::Vector3d(0.0, 0.0, 0.25 * body.weight));
}

LegVector VirtualModel::torques(const LegObservation& observation, const Feet& feet,
                                const BodyError& error) {
  const Eigen::Vector3d gravity =
      observation.attitude.inverse() * Eigen::Vector3d(0.0, 0.0, -kGravity);
  const Eigen::Vector3d centre = observation.attitude * body_.centre_of_mass_in_base;
  LegVector torques;
  std::vector<std::size_t> legs;
  std::vector<Eigen::Vector3d> levers;
  std::vector<Eigen::Vector3d> guess;
  for (std::size_t leg = 0; leg < 4; ++leg) {
    const auto joint = static_cast<Eigen::Index>(3 * leg);
    torques.segment<3>(joint) =
        stance_.legs[leg].weight_torques(observation.positions.segment<3>(joint), gravity);
    if (!feet.on_ground[leg]) {
      forces_[leg] = Eigen::Vector3d(0.0, 0.0, 0.5 * body_.weight);
      continue;
    }
    legs.push_back(leg);
    levers.push_back(feet.positions[leg] - centre);
    guess.push_back(forces_[leg]);
  }
  const auto forces = distribute_wrench(wrench(error), levers, kPlannedFriction * friction_, guess);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    forces_[legs[i]] = forces[i];
    torques.segment<3>(static_cast<Eigen::Index>(3 * legs[i])) -=
        feet.jacobians[legs[i]].transpose() * forces[i];
  }
  return torques;
}

Wrench VirtualModel::wrench(const BodyError& error) const {
  const Eigen::Vector3d acceleration = -springs_.position_stiffness.cwiseProduct(error.position) -
                                       springs_.position_damping.cwiseProduct(error.velocity);
  Wrench wrench;
  wrench.force = body_.weight * (Eigen::Vector3d::UnitZ() + acceleration / kGravity);
  wrench.torque = springs_.rotation_stiffness.cwiseProduct(error.rotation) -
                  springs_.rotation_damping.cwiseProduct(error.angular_velocity);
  return wrench;
}

}  // namespace v60_gait
