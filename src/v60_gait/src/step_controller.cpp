// SPDX-License-Identifier: BSD-3-Clause
#include "step_controller.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/se3.hpp>

namespace v60_gait {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Fit to motion capture of a Vision 60 with Jaco arm that steps on a treadmill, at rest and in
// light and heavy motion (see README): cadence, lift, springs, lag, heading, held point and placing
// errors.
constexpr double kSlowCadence = 1.25;     // 1/s, at rest
constexpr double kFastCadence = 1.37;     // 1/s
constexpr double kRestSpeed = 0.03;       // m/s, of the body over the deck
constexpr double kCadencePerSpeed = 2.5;  // 1/m
constexpr double kDuty = 0.51;            // part of the cycle that a foot is down
constexpr double kLift = 0.14;            // m
const VirtualSprings kSprings{
    {8.0, 4.0, 100.0}, {2.0, 3.0, 20.0}, {700.0, 1400.0, 500.0}, {70.0, 140.0, 60.0}};
const AttitudeReference::Gains kAttitude{1.0, 0.05, 0.25, 0.55};
constexpr double kHeldPoint = 0.1;  // m ahead of base_link: what is held at the standing height
// Standard deviation of where a pair of feet lands: ahead, m, to the left, m, and turned, rad; per
// rad/s of the body's roll and pitch, to which what there is at rest is added.
const Eigen::Vector3d kPlacingError(0.04, 0.010, 0.045);
constexpr double kRestAngularSpeed = 0.025;  // rad/s

constexpr double kSmoothingTime = 2.0;         // s, of speed and angular speed
constexpr double kBalanceGain = 0.05;          // s2, standing height / g
constexpr double kBalanceLearningRate = 0.05;  // 1/s, of where the body balances
constexpr double kSwingStiffness = 2000.0;     // N/m
constexpr double kSwingDamping = 60.0;         // N s/m
constexpr double kLandingDepth = 0.01;  // m, a foot aims so far below the ground that it lands

// The legs are a fifth of the weight. When the feet have moved until they are evenly about the
// centre of mass, the legs have moved it by a tenth of that way.
BodyModel over_balanced_feet(BodyModel body) {
  constexpr double kMovedByLegs = 0.1;
  body.centre_of_mass_in_base.head<2>() *= 1.0 + kMovedByLegs;
  return body;
}

}  // namespace

StepController::StepController(const Stance& stance, const BodyModel& body, double friction,
                               std::uint64_t seed)
    : stance_(stance),
      model_(stance, over_balanced_feet(body), friction, kSprings),
      attitude_(kAttitude),
      generator_(seed),
      cycles_(0.5 * static_cast<double>(generator_() % 2)),
      cadence_(kSlowCadence),
      balance_(over_balanced_feet(body).centre_of_mass_in_base.head<2>()),
      lift_off_(stance.toes_in_base) {}

LegVector StepController::torques(const LegObservation& observed) {
  const LegObservation observation = heading_.relative(observed);
  const double duration = has_time_ ? observation.time - last_time_ : 0.0;
  last_time_ = observation.time;
  has_time_ = true;
  advance(observation.time, duration);
  std::array<bool, 4> on_ground;
  for (std::size_t leg = 0; leg < 4; ++leg) {
    on_ground[leg] = observation.time < 0.0 || phase_of(leg) < kDuty;
  }
  const Feet feet = observe_feet(stance_, observation, on_ground);
  estimate(observation, feet, duration);
  LegVector torques = model_.torques(observation, feet, body_error(observation, feet));
  for (std::size_t leg = 0; leg < 4; ++leg) {
    if (on_ground[leg]) {
      lift_off_[leg] = feet.positions[leg];
    } else {
      torques.segment<3>(static_cast<Eigen::Index>(3 * leg)) +=
          feet.jacobians[leg].transpose() * swing_force(feet, leg);
    }
  }
  return torques;
}

// A pair of feet lands at each half cycle. The body is then held over where it landed, and the next
// pair gets a placing error of its own.
void StepController::advance(double time, double duration) {
  if (time < 0.0) return;
  const double half_cycles = std::floor(2.0 * cycles_);
  cycles_ += cadence_ * duration;
  if (std::floor(2.0 * cycles_) == half_cycles) return;
  offset_ -= placing_error_.head<2>();
  yaw_ += placing_error_.z();
  for (Eigen::Index i = 0; i < 3; ++i) {
    placing_error_[i] =
        kPlacingError[i] * (kRestAngularSpeed + angular_speed_) * normal_(generator_);
  }
}

// Part of the cycle, from 0 at touch-down; diagonal legs together.
double StepController::phase_of(std::size_t leg) const {
  const double cycles = cycles_ + ((leg == 0 || leg == 3) ? 0.0 : 0.5);
  return cycles - std::floor(cycles);
}

void StepController::estimate(const LegObservation& observation, const Feet& feet,
                              double duration) {
  velocity_ = body_velocity_over_feet(feet);
  if (observation.time < 0.0) {
    offset_ = body_over_feet(feet).head<2>() + balance_;
  } else {
    offset_ += duration * (velocity_ - observation.joystick).head<2>();
    balance_ += duration * kBalanceLearningRate * offset_;
  }
  yaw_ += duration * observation.joystick.z();
  slope_.update(feet, duration);
  attitude_.update(slope_.slope(), offset_.y(), duration);
  const double part = duration / (kSmoothingTime + duration);
  speed_ += part * (velocity_.head<2>().norm() - speed_);
  angular_speed_ += part * (observation.angular_velocity.head<2>().norm() - angular_speed_);
  cadence_ = std::clamp(kSlowCadence + kCadencePerSpeed * (speed_ - kRestSpeed), kSlowCadence,
                        kFastCadence);
}

BodyError StepController::body_error(const LegObservation& observation, const Feet& feet) const {
  const Eigen::Vector3d ahead = observation.attitude * Eigen::Vector3d::UnitX();
  const double height = body_over_feet(feet).z() + kHeldPoint * (ahead.z() + slope_.slope()[0]);
  BodyError error;
  error.position << offset_, height + stance_.toes_in_base[0].z();
  error.velocity = velocity_;
  if (observation.time < 0.0) {
    constexpr double kFactor = 2.0;  // so that the body is at rest when the trot begins
    error.position.head<2>() *= kFactor * kFactor;
    error.velocity.head<2>() *= kFactor;
  }
  error.rotation = prf_core::rotation_between(observation.attitude, attitude_.attitude(yaw_));
  error.angular_velocity = observation.attitude * observation.angular_velocity;
  return error;
}

// Where the feet balance the body at rest, further by half the way of a stance, and beyond that so
// that gravity, which gives g / h of acceleration per way off balance, gives what the springs ask
// for; on the deck's slope.
Eigen::Vector3d StepController::landing_place(std::size_t leg) const {
  const Eigen::Vector3d way(offset_.x(), offset_.y(), 0.0);
  const Eigen::Vector3d balance = kSprings.position_stiffness.cwiseProduct(way) +
                                  kSprings.position_damping.cwiseProduct(velocity_);
  const Eigen::AngleAxisd heading(yaw_ + placing_error_.z(), Eigen::Vector3d::UnitZ());
  Eigen::Vector3d place =
      heading * (stance_.toes_in_base[leg] + Eigen::Vector3d(balance_.x(), balance_.y(), 0.0));
  place.head<2>() += placing_error_.head<2>() + 0.5 * kDuty / cadence_ * velocity_.head<2>() +
                     kBalanceGain * balance.head<2>();
  place.z() += slope_.slope().dot(Eigen::Vector2d(-place.x(), place.y())) - kLandingDepth;
  return place;
}

Eigen::Vector3d StepController::swing_force(const Feet& feet, std::size_t leg) const {
  const double duration = (1.0 - kDuty) / cadence_;
  const double part = (phase_of(leg) - kDuty) / (1.0 - kDuty);
  const double blend = 0.5 * (1.0 - std::cos(kPi * part));
  const double blend_rate = 0.5 * kPi * std::sin(kPi * part) / duration;
  const double arc = kLift * std::sin(kPi * part) * std::sin(kPi * part);
  const double arc_rate = kLift * std::sin(2.0 * kPi * part) * kPi / duration;
  const Eigen::Vector3d way = landing_place(leg) - lift_off_[leg];
  const Eigen::Vector3d aim = lift_off_[leg] + blend * way + arc * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d aim_velocity = blend_rate * way + arc_rate * Eigen::Vector3d::UnitZ();
  return kSwingStiffness * (aim - feet.positions[leg]) +
         kSwingDamping * (aim_velocity - feet.velocities[leg]);
}

}  // namespace v60_gait
