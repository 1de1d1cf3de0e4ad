// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/arm_controller.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <sstream>

#include "prf_control/nearest_pose.hpp"

namespace prf_control {
namespace {

// [s] 1000 ticks at 100 Hz, which is what the joiner keeps.
constexpr double kLongestWait = 10.0;

ControlCode code_of(const FollowerStep& step) {
  if (step.goal == GoalKind::kNearest) return ControlCode::kUnreachable;
  if (step.goal == GoalKind::kJumpRefused || step.goal == GoalKind::kChangesBranch) {
    return ControlCode::kLimited;
  }
  const bool slowed =
      step.motion.limit == Limit::kVelocity || step.motion.limit == Limit::kPosition;
  return slowed ? ControlCode::kLimited : ControlCode::kFollowing;
}

const ArmControllerParams& validated(const ArmControllerParams& params) {
  params.validate();
  return params;
}

// Continuous joints may be reported in another turn than they are commanded in.
double tracking_error(double measured, double commanded, bool continuous) {
  const double error = measured - commanded;
  return std::abs(continuous ? std::remainder(error, 2.0 * M_PI) : error);
}

}  // namespace

void ArmControllerParams::validate() const {
  follower.validate();
  prf_core::require_positive_up_to("max_tracking_error", max_tracking_error, M_PI, "rad");
  prf_core::require_positive_up_to("max_wait", max_wait, kLongestWait, "s");
}

ArmController::ArmController(const ArmControllerParams& params)
    : params_(validated(params)),
      joiner_(prf_core::from_seconds(params_.max_wait)),
      follower_(params_.follower) {}

void ArmController::tune(double velocity_scale, double acceleration) {
  FollowerParams tuned = params_.follower;
  tuned.velocity_scale = velocity_scale;
  tuned.acceleration = acceleration;
  follower_.tune(tuned);
  params_.follower = tuned;
}

std::vector<ControlResult> ArmController::add_joints(const JointSample& joints) {
  joiner_.add_joints(joints);
  return process_joined_ticks();
}

std::vector<ControlResult> ArmController::add_setpoint(prf_core::Stamp stamp,
                                                       const Setpoint& setpoint) {
  joiner_.add_setpoint(stamp, setpoint);
  return process_joined_ticks();
}

std::vector<ControlResult> ArmController::process_joined_ticks() {
  std::vector<ControlResult> results;
  while (const auto tick = joiner_.next()) {
    if (const auto result = process(*tick)) results.push_back(*result);
  }
  return results;
}

std::optional<ControlResult> ArmController::process(const TickJoiner::Joined& tick) {
  ++counts_.ticks;
  if (tick.new_run) {
    follower_.reset();
    last_stamp_.reset();
  }
  if (!tick.primary.position) ++counts_.faulty_joints;
  if (!tick.primary.position && !follower_.started()) return std::nullopt;

  ControlResult result;
  result.stamp = tick.primary.stamp;
  const double dt = last_stamp_ ? prf_core::to_seconds(tick.primary.stamp - *last_stamp_) : 0.0;
  last_stamp_ = tick.primary.stamp;

  const std::string reason = restart_reason(tick, dt);
  if (reason.empty()) {
    follow_or_hold(tick, std::min(dt, params_.max_wait), result);
  } else {
    restart(*tick.primary.position, reason, result);
  }
  result.command = follower_.state();
  return result;
}

std::string ArmController::restart_reason(const TickJoiner::Joined& tick, double dt) const {
  if (!tick.primary.position) return "";
  if (!follower_.started()) return "first joint positions of the run";
  std::ostringstream text;
  if (dt > params_.max_wait) {
    text << "joint_states jumped forward by " << dt << " s, bound " << params_.max_wait << " s";
    return text.str();
  }
  const auto& limits = jaco_kinematics::jaco_joint_limits();
  for (int i = 0; i < 7; ++i) {
    const double error = tracking_error((*tick.primary.position)[i], follower_.state().position[i],
                                        std::isinf(limits.upper[i]));
    if (error <= params_.max_tracking_error) continue;
    text << name(i) << " is " << error << " rad from its command, bound "
         << params_.max_tracking_error << " rad";
    return text.str();
  }
  return "";
}

void ArmController::restart(const JointVector& measured, const std::string& reason,
                            ControlResult& result) {
  ++counts_.restarts;
  follower_.start(measured);
  result.restarted = true;
  result.reason = "starts from the measured joints: " + reason;
}

void ArmController::follow_or_hold(const TickJoiner::Joined& tick, double dt,
                                   ControlResult& result) {
  Eigen::Isometry3d wanted;
  if (tick.primary.position && tick.secondary && tick.secondary->kind == SetpointKind::kPose) {
    follow(tick.secondary->pose, dt, result);
    wanted = tick.secondary->pose.hand_in_base;
  } else {
    follower_.hold(dt);
    wanted = jaco_kinematics::forward(follower_.state().position);
    if (!tick.primary.position) {
      result.reason = tick.primary.fault;
    } else if (!tick.secondary) {
      result.code = ControlCode::kStaleSetpoint;
      result.reason = "no set-point for this tick";
    } else if (tick.secondary->kind == SetpointKind::kInvalid) {
      ++counts_.invalid_setpoints;
      result.code = ControlCode::kInvalidSetpoint;
      result.reason = tick.secondary->refusal;
    }
  }
  const JointVector hand = tick.primary.position.value_or(follower_.state().position);
  const auto error = pose_error(jaco_kinematics::forward(hand), wanted);
  result.position_error = error.head<3>().norm();
  result.orientation_error = error.tail<3>().norm();
}

void ArmController::follow(const PoseSetpoint& setpoint, double dt, ControlResult& result) {
  const FollowerStep step = follower_.follow(setpoint, dt);
  if (step.goal == GoalKind::kJumpRefused) ++counts_.refused_jumps;
  if (step.goal == GoalKind::kChangesBranch) ++counts_.branch_changing;
  result.code = code_of(step);
  result.deviation = step.position_deviation;
  if (result.code != ControlCode::kFollowing) result.reason = describe(step);
}

std::string ArmController::describe(const FollowerStep& step) const {
  std::ostringstream text;
  if (step.goal == GoalKind::kNearest) {
    text << "no joint position within limits gives the pose; goes to the nearest, now "
         << step.position_deviation << " m and " << step.orientation_deviation << " rad from it";
  } else if (step.goal == GoalKind::kJumpRefused) {
    text << name(step.jump_joint) << " would jump by " << step.jump << " rad, bound "
         << params_.follower.max_joint_step << " rad; creeps toward the pose";
  } else if (step.goal == GoalKind::kChangesBranch) {
    text << "changes branch slowly, " << name(step.jump_joint) << " has " << step.jump
         << " rad to go";
  } else {
    const bool position = step.motion.limit == Limit::kPosition;
    text << name(step.motion.joint) << (position ? " near its position limit, " : " ") << "asked "
         << step.motion.asked << " rad/s, bound " << step.motion.bound << " rad/s";
  }
  return text.str();
}

std::string ArmController::name(int joint) const {
  return params_.joint_prefix + std::to_string(joint + 1);
}

}  // namespace prf_control
