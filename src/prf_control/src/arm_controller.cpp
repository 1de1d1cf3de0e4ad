// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/arm_controller.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <utility>

#include "prf_control/command_gate.hpp"
#include "prf_control/nearest_pose.hpp"
#include "reasons.hpp"

namespace prf_control {
namespace {

ControlCode code_of(const FollowerStep& step) {
  if (step.goal == GoalKind::kNearest) return ControlCode::kUnreachable;
  if (step.goal == GoalKind::kJumpRefused || step.goal == GoalKind::kChangesBranch ||
      step.goal == GoalKind::kInside) {
    return ControlCode::kLimited;
  }
  const bool slowed =
      step.motion.limit == Limit::kVelocity || step.motion.limit == Limit::kPosition;
  return slowed ? ControlCode::kLimited : ControlCode::kFollowing;
}

constexpr double kLeastScale =
    0.01;  // of the follower; an arm that must not move is held elsewhere

FollowerParams slowed(FollowerParams params, double speed) {
  params.velocity_scale = std::max(kLeastScale, speed * params.velocity_scale);
  return params;
}

const ArmControllerParams& validated(const ArmControllerParams& params) {
  params.validate();
  return params;
}

}  // namespace

void ArmControllerParams::validate() const {
  follower.validate();
  prf_core::require_between("max_tracking_error", max_tracking_error, 0.01, 1.0, "rad");
  prf_core::require_between("max_wait", max_wait, 0.02, 5.0, "s");
}

ArmController::ArmController(Arm arm, const ArmControllerParams& params)
    : params_(validated(params)),
      joiner_(prf_core::from_seconds(params_.max_wait)),
      follower_(std::move(arm), params_.follower) {
  const auto wanted = static_cast<std::size_t>(follower_.arm().joint_count());
  prf_core::require(params_.joints.size() == wanted, "joints", params_.joints.size(),
                    std::to_string(wanted) + " names");
}

void ArmController::tune(double velocity_scale, double acceleration) {
  FollowerParams tuned = params_.follower;
  tuned.velocity_scale = velocity_scale;
  tuned.acceleration = acceleration;
  tuned.validate();
  follower_.tune(slowed(tuned, applied_speed_));
  params_.follower = tuned;
}

void ArmController::apply_speed(prf_core::Stamp tick) {
  const double speed = speed_.at(tick);
  if (speed == applied_speed_) return;
  applied_speed_ = speed;
  follower_.tune(slowed(params_.follower, speed));
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
  while (const auto joined = joiner_.next()) results.push_back(process(*joined));
  return results;
}

struct ArmController::Tick {
  std::optional<JointVector> reported;
  std::optional<JointVector> measured;  // unwrapped
  std::string fault;                    // why the arm must not be moved
  std::optional<Setpoint> setpoint;
  double gap = 0.0;  // [s] since the tick before
  double dt = 0.0;   // the same, at most max_wait

  [[nodiscard]] bool has_pose() const { return setpoint && setpoint->kind == SetpointKind::kPose; }
};

ArmController::Tick ArmController::tick_of(const TickJoiner::Joined& joined) {
  const prf_core::Stamp stamp = joined.primary.stamp;
  Tick tick;
  tick.setpoint = joined.secondary;
  tick.gap = last_stamp_ ? prf_core::to_seconds(stamp - *last_stamp_) : 0.0;
  tick.dt = std::min(tick.gap, params_.max_wait);
  last_stamp_ = stamp;
  tick.fault = joined.primary.fault;
  if (!joined.primary.position) {
    if (tick.fault.empty()) tick.fault = "joint positions are not known";
    return tick;
  }
  tick.reported = joined.primary.position;
  tick.measured = unwrapped(*tick.reported, joint_limits());
  int joint = 0;
  if (joints_outside(*tick.measured, joint_limits()).maxCoeff(&joint) > kFarOutside) {
    tick.fault = reasons().outside(*tick.measured, joint) + ": is not moved from there";
  }
  return tick;
}

Reasons ArmController::reasons() const { return {params_.joints, joint_limits()}; }

ControlResult ArmController::process(const TickJoiner::Joined& joined) {
  ++counts_.ticks;
  if (joined.new_run) {
    follower_.reset();
    last_stamp_.reset();
    measured_.reset();
    speed_.reset();
  }
  apply_speed(joined.primary.stamp);
  const Tick tick = tick_of(joined);
  if (!tick.fault.empty()) ++counts_.faulty_joints;
  if (tick.measured) measured_ = tick.measured;

  ControlResult result;
  result.stamp = joined.primary.stamp;
  std::optional<MotionState> last;
  if (follower_.started()) {
    if (tick.measured) follow_into_turn(*tick.measured);
    last = follower_.state();
  }
  const std::string reason = restart_reason(tick);
  if (!reason.empty()) {
    restart(tick, reason, result);
  } else if (last) {
    follow_or_hold(tick, result);
  }
  if (!tick.fault.empty()) {
    result.code = ControlCode::kFailing;
    result.reason = tick.fault;
  }
  if (follower_.started()) pass_gate(tick, last, result);
  measure_error(tick, last, result);
  return result;
}

void ArmController::follow_into_turn(const JointVector& measured) {
  const JointVector turns = turns_between(follower_.state().position, measured, joint_limits());
  if (turns.isZero(0.0)) return;
  ++counts_.other_turns;
  follower_.move_by_turns(turns);
}

std::string ArmController::restart_reason(const Tick& tick) const {
  if (!tick.measured) return "";
  if (!follower_.started()) return "first joint positions of the run";
  if (tick.gap > params_.max_wait) return reasons().leap(tick.gap, params_.max_wait);
  int joint = 0;
  const JointVector lag = (*tick.measured - follower_.state().position).cwiseAbs();
  if (lag.maxCoeff(&joint) <= params_.max_tracking_error) return "";
  return reasons().lag(joint, lag[joint], params_.max_tracking_error);
}

void ArmController::restart(const Tick& tick, const std::string& reason, ControlResult& result) {
  ++counts_.restarts;
  follower_.start(*tick.measured);
  result.restarted = true;
  result.reason = "starts from the measured joints: " + reason +
                  reasons().turns(*tick.reported, *tick.measured);
  int joint = 0;
  if (joints_outside(*tick.measured, joint_limits()).maxCoeff(&joint) > 0.0) {
    result.reason += "; " + reasons().outside(*tick.measured, joint);
  }
}

void ArmController::follow_or_hold(const Tick& tick, ControlResult& result) {
  if (tick.fault.empty() && tick.has_pose()) {
    follow(tick.setpoint->pose, tick.dt, result);
  } else {
    hold(tick, result);
  }
}

void ArmController::hold(const Tick& tick, ControlResult& result) {
  follower_.hold(tick.dt);
  if (!tick.setpoint) {
    result.code = ControlCode::kStaleSetpoint;
    result.reason = "no set-point for this tick";
  } else if (tick.setpoint->kind == SetpointKind::kInvalid) {
    ++counts_.invalid_setpoints;
    result.code = ControlCode::kInvalidSetpoint;
    result.reason = tick.setpoint->refusal;
  }
  int joint = 0;
  if (joints_outside(follower_.state().position, joint_limits()).maxCoeff(&joint) > 0.0) {
    result.reason += (result.reason.empty() ? "" : "; ") +
                     reasons().outside(follower_.state().position, joint) + ": holds there";
  }
}

void ArmController::follow(const PoseSetpoint& setpoint, double dt, ControlResult& result) {
  const FollowerStep step = follower_.follow(setpoint, dt);
  if (step.goal == GoalKind::kJumpRefused) ++counts_.refused_jumps;
  if (step.goal == GoalKind::kChangesBranch) ++counts_.branch_changing;
  result.code = code_of(step);
  result.deviation = step.position_deviation;
  if (result.code != ControlCode::kFollowing) {
    result.reason = reasons().step(step, params_.follower.max_joint_step);
  }
}

// The only place from which a command leaves the controller.
void ArmController::pass_gate(const Tick& tick, const std::optional<MotionState>& last,
                              ControlResult& result) {
  GateInput input;
  input.wanted = follower_.state();
  input.measured = tick.measured;
  input.dt = tick.dt;
  input.anew = result.restarted;
  input.before = result.restarted ? at_rest(*tick.measured) : *last;
  const GateOutput output =
      prf_control::pass_gate(input, follower_.limits(), params_.max_tracking_error);
  result.command = output.command;
  if (output.refusal.empty()) return;
  ++counts_.refused_commands;
  follower_.start(output.command);
  result.code = ControlCode::kFailing;
  result.reason = output.refusal;
  result.restarted = result.restarted || output.anew;
}

void ArmController::measure_error(const Tick& tick, const std::optional<MotionState>& last,
                                  ControlResult& result) const {
  if (!measured_) {
    result.position_error = result.orientation_error = std::nan("");
    return;
  }
  // Where the command has begun anew, the hand is compared with where it should have been.
  const MotionState& held = result.restarted && last ? *last : *result.command;
  const Eigen::Isometry3d wanted =
      tick.has_pose() ? tick.setpoint->pose.hand_in_base : follower_.arm().forward(held.position);
  const auto error = pose_error(follower_.arm().forward(*measured_), wanted);
  result.position_error = error.head<3>().norm();
  result.orientation_error = error.tail<3>().norm();
}

}  // namespace prf_control
