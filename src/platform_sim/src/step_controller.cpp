// SPDX-License-Identifier: BSD-3-Clause
#include "step_controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gravity.hpp"

namespace platform_sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kCycle = 0.8;  // s
constexpr double kDuty = 0.54;  // part of the cycle that a foot is down
constexpr double kLift = 0.08;  // m

constexpr double kLeaning = 0.5;          // part of the deck's slope that the body follows
constexpr double kSlopeLearning = 12.0;   // 1/s
constexpr double kTilt = 2000.0;          // Nm/rad
constexpr double kTiltRate = 200.0;       // Nm s/rad
constexpr double kWay = 4.0;              // 1/s2
constexpr double kWayRate = 6.0;          // 1/s
constexpr double kHeight = 100.0;         // 1/s2
constexpr double kHeightRate = 20.0;      // 1/s
constexpr double kRaibert = 0.05;         // s
constexpr double kSwing = 2000.0;         // N/m
constexpr double kSwingRate = 60.0;       // N s/m
constexpr double kPressDown = 0.01;       // m, aim of a foot below the ground so that it lands
constexpr double kPlannedFriction = 0.8;  // of the friction there is

// Part of the cycle, from 0 at touch-down; diagonal legs together.
double leg_phase(std::size_t leg, double time) {
  const double offset = (leg == 0 || leg == 3) ? 0.0 : 0.5;
  const double cycles = time / kCycle + offset;
  return cycles - std::floor(cycles);
}

// Rotation vector that turns `from` into `to`, both rotations.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::AngleAxisd turn(to * from.inverse());
  return turn.angle() * turn.axis();
}

}  // namespace

StepController::StepController(const Stance& stance, const BodyModel& body, double friction)
    : stance_(stance), body_(body), friction_(friction), lift_off_(stance.toes_in_base) {
  forces_.fill(Eigen::Vector3d(0.0, 0.0, 0.25 * body.weight));
}

LegVector StepController::torques(const LegObservation& observation) {
  const Feet feet = observe(observation);
  estimate_body(feet, observation.time);
  const Eigen::Vector3d gravity =
      observation.attitude.inverse() * Eigen::Vector3d(0.0, 0.0, -kGravity);
  LegVector torques;
  for (std::size_t leg = 0; leg < 4; ++leg) {
    const auto joint = static_cast<Eigen::Index>(3 * leg);
    torques.segment<3>(joint) =
        stance_.legs[leg].weight_torques(observation.positions.segment<3>(joint), gravity);
  }
  carry(observation, feet, torques);
  for (std::size_t leg = 0; leg < 4; ++leg) {
    if (feet.on_ground[leg]) {
      lift_off_[leg] = feet.positions[leg];
    } else {
      swing(observation, feet, leg, torques);
    }
  }
  return torques;
}

StepController::Feet StepController::observe(const LegObservation& observation) const {
  Feet feet;
  const Eigen::Matrix3d rotation = observation.attitude.toRotationMatrix();
  for (std::size_t leg = 0; leg < 4; ++leg) {
    const auto joint = static_cast<Eigen::Index>(3 * leg);
    const Eigen::Vector3d angles = observation.positions.segment<3>(joint);
    const Eigen::Vector3d toe = stance_.legs[leg].toe(angles);
    feet.jacobians[leg] = rotation * stance_.legs[leg].jacobian(angles);
    feet.positions[leg] = rotation * toe;
    feet.velocities[leg] = feet.jacobians[leg] * observation.velocities.segment<3>(joint) +
                           rotation * observation.angular_velocity.cross(toe);
    feet.on_ground[leg] = observation.time < 0.0 || leg_phase(leg, observation.time) < kDuty;
  }
  return feet;
}

void StepController::estimate_body(const Feet& feet, double time) {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  double grounded = 0.0;
  for (std::size_t leg = 0; leg < 4; ++leg) {
    if (!feet.on_ground[leg]) continue;
    velocity -= feet.velocities[leg];
    grounded += 1.0;
  }
  if (grounded > 0.0) body_velocity_ = velocity / grounded;
  if (has_time_) {
    body_way_ += (time - last_time_) * body_velocity_;
    estimate_slope(feet, time - last_time_);
  }
  last_time_ = time;
  has_time_ = true;
}

// Feet i and j on a deck of pitch p and roll r: z_i - z_j = -p (x_i - x_j) + r (y_i - y_j). One
// diagonal pair cannot tell p from r; the two in turn can.
void StepController::estimate_slope(const Feet& feet, double duration) {
  for (const auto& [front, rear] : {std::pair<std::size_t, std::size_t>{0, 3}, {1, 2}}) {
    if (!feet.on_ground[front] || !feet.on_ground[rear]) continue;
    const Eigen::Vector3d way = feet.positions[front] - feet.positions[rear];
    const Eigen::Vector2d direction(-way.x(), way.y());
    const double error = way.z() - direction.dot(slope_);
    slope_ += kSlopeLearning * duration * error / direction.squaredNorm() * direction;
  }
}

// Virtual springs and dampers: between level and the deck's slope, straight ahead, back over the
// starting point, and at the standing height over the feet.
Wrench StepController::balance(const LegObservation& observation, const Feet& feet) const {
  double height = 0.0;
  double grounded = 0.0;
  for (std::size_t leg = 0; leg < 4; ++leg) {
    if (!feet.on_ground[leg]) continue;
    height -= feet.positions[leg].z();
    grounded += 1.0;
  }
  const double height_error = -stance_.toes_in_base[0].z() - height / grounded;
  const Eigen::Vector3d acceleration(-kWay * body_way_.x() - kWayRate * body_velocity_.x(),
                                     -kWay * body_way_.y() - kWayRate * body_velocity_.y(),
                                     kHeight * height_error - kHeightRate * body_velocity_.z());
  Wrench wanted;
  wanted.force = body_.weight * (Eigen::Vector3d::UnitZ() + acceleration / kGravity);
  const Eigen::Quaterniond attitude =
      Eigen::AngleAxisd(kLeaning * slope_[0], Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(kLeaning * slope_[1], Eigen::Vector3d::UnitX());
  wanted.torque = kTilt * rotation_vector(observation.attitude, attitude) -
                  kTiltRate * (observation.attitude * observation.angular_velocity);
  return wanted;
}

void StepController::carry(const LegObservation& observation, const Feet& feet,
                           LegVector& torques) {
  const Eigen::Vector3d centre = observation.attitude * body_.centre_of_mass_in_base;
  std::vector<std::size_t> legs;
  std::vector<Eigen::Vector3d> levers;
  std::vector<Eigen::Vector3d> guess;
  for (std::size_t leg = 0; leg < 4; ++leg) {
    if (!feet.on_ground[leg]) continue;
    legs.push_back(leg);
    levers.push_back(feet.positions[leg] - centre);
    guess.push_back(forces_[leg]);
  }
  const auto forces =
      distribute_wrench(balance(observation, feet), levers, kPlannedFriction * friction_, guess);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    forces_[legs[i]] = forces[i];
    torques.segment<3>(static_cast<Eigen::Index>(3 * legs[i])) -=
        feet.jacobians[legs[i]].transpose() * forces[i];
  }
}

void StepController::swing(const LegObservation& observation, const Feet& feet, std::size_t leg,
                           LegVector& torques) {
  constexpr double kDuration = (1.0 - kDuty) * kCycle;
  const double part = (leg_phase(leg, observation.time) - kDuty) / (1.0 - kDuty);
  const double blend = 0.5 * (1.0 - std::cos(kPi * part));
  const double blend_rate = 0.5 * kPi * std::sin(kPi * part) / kDuration;

  // Around the centre of mass, and ahead by half the way of a stance plus the part that brakes.
  Eigen::Vector3d landing = stance_.toes_in_base[leg];
  landing.head<2>() += (observation.attitude * body_.centre_of_mass_in_base).head<2>() +
                       (0.5 * kDuty * kCycle + kRaibert) * body_velocity_.head<2>();
  landing.z() -= kPressDown;
  const double arc = kLift * std::sin(kPi * part) * std::sin(kPi * part);
  const double arc_rate = kLift * std::sin(2.0 * kPi * part) * kPi / kDuration;
  const Eigen::Vector3d way = landing - lift_off_[leg];
  const Eigen::Vector3d aim = lift_off_[leg] + blend * way + arc * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d aim_velocity = blend_rate * way + arc_rate * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d pull =
      kSwing * (aim - feet.positions[leg]) + kSwingRate * (aim_velocity - feet.velocities[leg]);
  torques.segment<3>(static_cast<Eigen::Index>(3 * leg)) = feet.jacobians[leg].transpose() * pull;
  forces_[leg] = Eigen::Vector3d(0.0, 0.0, 0.5 * body_.weight);
}

}  // namespace platform_sim
