// SPDX-License-Identifier: BSD-3-Clause
#include "stand_controller.hpp"

#include <cmath>
#include <prf_core/se3.hpp>

namespace v60_gait {
namespace {

// Horizontal springs, leaning, lag and banking: fit to motion capture of a Vision 60 with Jaco arm
// standing on a treadmill that sways at 2.0 and 2.4 rad/s and pitches at 1.5 and 2.4 rad/s (see
// README). The others only have to be stiff.
const VirtualSprings kSprings{
    {10.0, 10.0, 100.0}, {4.7, 4.7, 20.0}, {2000.0, 2000.0, 500.0}, {200.0, 200.0, 60.0}};
const AttitudeReference::Gains kAttitude{0.72, 0.07, 1.8, 0.0};

double yaw_of(const Eigen::Vector3d& way) { return std::atan2(way.y(), way.x()); }

}  // namespace

StandController::StandController(const Stance& stance, const BodyModel& body, double friction)
    : stance_(stance), model_(stance, body, friction, kSprings), attitude_(kAttitude) {}

LegVector StandController::torques(const LegObservation& observed) {
  const LegObservation observation = heading_.relative(observed);
  const double duration = has_time_ ? observation.time - last_time_ : 0.0;
  last_time_ = observation.time;
  has_time_ = true;
  const Feet feet = observe_feet(stance_, observation, {true, true, true, true});
  slope_.update(feet, duration);
  BodyError error;
  error.position = body_over_feet(feet) + Eigen::Vector3d(0.0, 0.0, stance_.toes_in_base[0].z());
  error.velocity = body_velocity_over_feet(feet);
  attitude_.update(slope_.slope(), error.position.y(), duration);
  const auto& toes = feet.positions;
  const double yaw = yaw_of(toes[0] + toes[1] - toes[2] - toes[3]);
  error.rotation = prf_core::rotation_between(observation.attitude, attitude_.attitude(yaw));
  error.angular_velocity = observation.attitude * observation.angular_velocity;
  return model_.torques(observation, feet, error);
}

}  // namespace v60_gait
