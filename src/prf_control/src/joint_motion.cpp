// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/joint_motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace prf_control {
namespace {

// Share of the acceleration that is planned for braking along the way to the goal. The rest turns
// the motion toward the goal, so that a goal approached from the side is not circled. Ours
// (test_joint_motion, SettlesSoonOnAGoalGivenInFullMotion).
constexpr double kBrakingShare = 0.6;

void check(const MotionState& state, const char* name) {
  if (!state.position.allFinite() || !state.velocity.allFinite()) {
    throw std::invalid_argument(std::string(name) + " has a non-finite position or velocity");
  }
}

void check_dt(double dt) {
  if (!(std::isfinite(dt) && dt > 0.0)) {
    throw std::invalid_argument("dt = " + std::to_string(dt) + " s, must be finite and > 0");
  }
}

// Fastest speed toward a limit at `distance` from which braking still ends before it, whatever the
// later periods are: v dt + v^2 / (2 a) = distance.
double braking_bound(double distance, double acceleration, double dt) {
  const double d = std::max(distance, 0.0);
  return acceleration * (std::sqrt(dt * dt + 2.0 * d / acceleration) - dt);
}

// The largest change of a joint's velocity v in a direction: `braking` to rest, `acceleration` from
// there on.
double velocity_change(double v, bool upward, int joint, double dt, const MotionLimits& limits) {
  const double speeding_up = limits.acceleration[joint] * dt;
  const bool slows_down = upward ? v < 0.0 : v > 0.0;
  if (!slows_down) return speeding_up;
  return std::max(speeding_up, std::min(limits.braking[joint] * dt, std::abs(v)));
}

// A joint outside its limits keeps its place as the limit, until it is inside.
double within(double position, double before, int joint, const MotionLimits& limits) {
  return std::clamp(position, std::min(limits.lower[joint], before),
                    std::max(limits.upper[joint], before));
}

// How fast a joint may move toward its position limits: not at all beyond them.
struct Speeds {
  double down;
  double up;
};

Speeds speeds_to_limits(double position, int joint, double dt, const MotionLimits& limits) {
  const double braking = limits.braking[joint];
  return {braking_bound(position - limits.lower[joint], braking, dt),
          braking_bound(limits.upper[joint] - position, braking, dt)};
}

void note(LimitedStep& step, Limit limit, int joint, double asked, double bound) {
  step.limit = limit;
  step.joint = joint;
  step.asked = asked;
  step.bound = bound;
}

// The largest share of `change` that keeps every |change_i| <= bound_i, and the joint that sets it.
struct Share {
  double value = 1.0;
  int joint = -1;
};

Share common_share(const JointVector& change, const JointVector& bound) {
  Share share;
  for (int i = 0; i < change.size(); ++i) {
    const double size = std::abs(change[i]);
    if (size * share.value > bound[i]) share = {bound[i] / size, i};
  }
  return share;
}

LimitedStep step_with_velocity(const MotionState& state, const JointVector& wanted, double dt,
                               const MotionLimits& limits) {
  LimitedStep step;
  step.state = state;
  const Share speed = common_share(wanted, limits.velocity);
  const JointVector allowed = speed.value * wanted;

  const JointVector change = allowed - state.velocity;
  JointVector largest_change(change.size());
  for (int i = 0; i < change.size(); ++i) {
    largest_change[i] = velocity_change(state.velocity[i], change[i] > 0.0, i, dt, limits);
  }
  const Share thrust = common_share(change, largest_change);
  if (thrust.joint >= 0) {
    note(step, Limit::kAcceleration, thrust.joint, change[thrust.joint] / dt,
         largest_change[thrust.joint] / dt);
  } else if (speed.joint >= 0) {
    note(step, Limit::kVelocity, speed.joint, wanted[speed.joint], limits.velocity[speed.joint]);
  }

  for (int i = 0; i < change.size(); ++i) {
    const double asked = state.velocity[i] + thrust.value * change[i];
    const double q = state.position[i];
    const Speeds speeds = speeds_to_limits(q, i, dt, limits);
    const double v = std::clamp(asked, -speeds.down, speeds.up);
    if (v != asked) note(step, Limit::kPosition, i, asked, v);
    step.state.velocity[i] = v;
    step.state.position[i] = within(q + v * dt, q, i, limits);
  }
  return step;
}

}  // namespace

void MotionLimits::validate() const {
  for (int i = 0; i < lower.size(); ++i) {
    const std::string joint = " of joint " + std::to_string(i + 1);
    if (!(lower[i] < upper[i])) {
      throw std::invalid_argument("lower limit" + joint + " is not below the upper limit");
    }
    if (!(std::isfinite(velocity[i]) && velocity[i] > 0.0)) {
      throw std::invalid_argument("velocity limit" + joint + " must be finite and > 0");
    }
    if (!(std::isfinite(acceleration[i]) && acceleration[i] > 0.0)) {
      throw std::invalid_argument("acceleration limit" + joint + " must be finite and > 0");
    }
    if (!(std::isfinite(braking[i]) && braking[i] >= acceleration[i])) {
      throw std::invalid_argument("braking" + joint + " must be finite and >= its acceleration");
    }
  }
}

// Speeds (n + f) a dt, (n - 1 + f) a dt, ..., f a dt with 0 <= f < 1 cover, each for one dt,
//   distance = a dt^2 (n (n + 1) / 2 + (n + 1) f),
// solved for the whole number n and the rest f.
double approach_speed(double distance, double deceleration, double dt) {
  const double unit = deceleration * dt * dt;
  const double e = std::max(distance, 0.0) / unit;
  const double n = std::floor(0.5 * (std::sqrt(1.0 + 8.0 * e) - 1.0));
  const double f = (e - 0.5 * n * (n + 1.0)) / (n + 1.0);
  return (n + f) * deceleration * dt;
}

VelocityRange allowed_velocities(const MotionState& state, double dt, const MotionLimits& limits) {
  check(state, "state");
  check_dt(dt);
  VelocityRange range{state.velocity, state.velocity};
  for (int i = 0; i < range.lower.size(); ++i) {
    const double v = state.velocity[i];
    const double least = v - velocity_change(v, false, i, dt, limits);
    const double most = v + velocity_change(v, true, i, dt, limits);
    double lower = std::max(-limits.velocity[i], least);
    double upper = std::min(limits.velocity[i], most);
    if (lower > upper) lower = upper = v > 0 ? least : most;
    const Speeds speeds = speeds_to_limits(state.position[i], i, dt, limits);
    range.lower[i] = std::clamp(lower, -speeds.down, speeds.up);
    range.upper[i] = std::clamp(upper, -speeds.down, speeds.up);
  }
  return range;
}

MotionState moved(const MotionState& state, const JointVector& velocity, double dt,
                  const MotionLimits& limits) {
  MotionState result{state.position + velocity * dt, velocity};
  for (int i = 0; i < velocity.size(); ++i) {
    result.position[i] = within(result.position[i], state.position[i], i, limits);
  }
  return result;
}

LimitedStep step_toward(const MotionState& state, const MotionState& goal, double dt,
                        const MotionLimits& limits) {
  check(state, "state");
  check(goal, "goal");
  check_dt(dt);
  // Seen from the goal, which moves on by goal.velocity dt itself in this period.
  const JointVector remaining = goal.position - goal.velocity * dt - state.position;
  const double distance = remaining.norm();
  if (distance == 0.0) return step_with_velocity(state, goal.velocity, dt, limits);

  const JointVector direction = remaining / distance;
  const double reach = (direction.cwiseAbs().cwiseQuotient(limits.acceleration)).maxCoeff();
  const double speed = approach_speed(distance, kBrakingShare / reach, dt);
  return step_with_velocity(state, goal.velocity + speed * direction, dt, limits);
}

LimitedStep step_to_rest(const MotionState& state, double dt, const MotionLimits& limits) {
  check(state, "state");
  check_dt(dt);
  return step_with_velocity(state, JointVector::Zero(state.position.size()), dt, limits);
}

}  // namespace prf_control
