// SPDX-License-Identifier: BSD-3-Clause
// One control period of a joint motion within position, velocity and acceleration limits.
//
//   q' = q + v' dt     lower <= q' <= upper     |v'| <= velocity     |v' - v| <= acceleration dt
//
// A joint that slows down may do so by up to `braking` dt instead of acceleration dt.
// The limits are kept for any sequence of dt > 0, from any state that keeps them and can still
// brake before the position limits. A joint outside its position limits never goes farther out. All
// joints are slowed by one factor, so a motion from rest to a goal at rest is a straight line in
// joint space, without overshoot.
// Units: radians (a prismatic joint: metres), seconds. All vectors have one entry a joint.
// std::invalid_argument for non-finite input or dt <= 0.
#pragma once

#include <arm_kinematics/arm_kinematics.hpp>

namespace prf_control {

using arm_kinematics::JointVector;

struct MotionLimits {
  JointVector lower;         // [rad], -infinity where the joint is continuous
  JointVector upper;         // [rad]
  JointVector velocity;      // [rad/s], > 0
  JointVector acceleration;  // [rad/s^2], > 0
  JointVector braking;       // [rad/s^2], >= acceleration

  void validate() const;
};

struct MotionState {
  JointVector position;  // [rad]
  JointVector velocity;  // [rad/s]
};

[[nodiscard]] inline MotionState at_rest(const JointVector& position) {
  return {position, JointVector::Zero(position.size())};
}

struct VelocityRange {
  JointVector lower;  // [rad/s]
  JointVector upper;  // [rad/s]
};

// The velocities that one period may end with: within all limits, and slow enough to brake before
// the position limits. A joint that is too fast already may only brake.
[[nodiscard]] VelocityRange allowed_velocities(const MotionState& state, double dt,
                                               const MotionLimits& limits);

// The state after one period at a velocity from that range.
[[nodiscard]] MotionState moved(const MotionState& state, const JointVector& velocity, double dt,
                                const MotionLimits& limits);

enum class Limit { kNone, kAcceleration, kVelocity, kPosition };

struct LimitedStep {
  MotionState state;
  Limit limit = Limit::kNone;  // what shaped this step, position before the others
  int joint = -1;              // the joint that met it
  double asked = 0.0;          // without the limit: [rad/s], [rad/s^2] for acceleration
  double bound = 0.0;          // the limit, same unit
};

// Fastest speed from which braking by `deceleration` in periods of dt ends exactly at `distance`.
double approach_speed(double distance, double deceleration, double dt);

// Toward a goal that moves with goal.velocity: meets and follows it if the limits allow.
[[nodiscard]] LimitedStep step_toward(const MotionState& state, const MotionState& goal, double dt,
                                      const MotionLimits& limits);

// Toward rest, in the direction of motion.
[[nodiscard]] LimitedStep step_to_rest(const MotionState& state, double dt,
                                       const MotionLimits& limits);

}  // namespace prf_control
