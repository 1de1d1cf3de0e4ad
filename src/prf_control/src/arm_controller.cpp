// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/arm_controller.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "prf_control/nearest_pose.hpp"

namespace prf_control {
namespace {

ControlCode code_of(const FollowerStep& step) {
  if (step.goal == GoalKind::kNearest) return ControlCode::kUnreachable;
  if (step.goal == GoalKind::kJumpRefused || step.goal == GoalKind::kChangesBranch) {
    return ControlCode::kLimited;
  }
  const bool slowed =
      step.motion.limit == Limit::kVelocity || step.motion.limit == Limit::kPosition;
  return slowed ? ControlCode::kLimited : ControlCode::kFollowing;
}

// Joints without end may be reported in another turn than they are commanded in.
double tracking_error(double measured, double commanded, bool endless) {
  const double error = measured - commanded;
  return std::abs(endless ? std::remainder(error, 2.0 * M_PI) : error);
}

}  // namespace

void ArmControllerParams::validate() const {
  follower.validate();
  if (!(std::isfinite(max_tracking_error) && max_tracking_error > 0.0 &&
        max_tracking_error <= M_PI)) {
    throw std::invalid_argument("max_tracking_error = " + std::to_string(max_tracking_error) +
                                " rad, must be > 0 and <= pi");
  }
}

ArmController::ArmController(const ArmControllerParams& params)
    : params_(params), joiner_(params.max_wait), follower_(params.follower) {
  params_.validate();
}

void ArmController::tune(double velocity_scale, double acceleration) {
  FollowerParams tuned = params_.follower;
  tuned.velocity_scale = velocity_scale;
  tuned.acceleration = acceleration;
  follower_.tune(tuned);
  params_.follower = tuned;
}

std::vector<Answer> ArmController::add_joints(const JointSample& joints) {
  joiner_.add_joints(joints);
  return decided();
}

std::vector<Answer> ArmController::add_setpoint(std::int64_t stamp_ns, const Setpoint& setpoint) {
  joiner_.add_setpoint(stamp_ns, setpoint);
  return decided();
}

std::vector<Answer> ArmController::decided() {
  std::vector<Answer> answers;
  while (const auto tick = joiner_.next()) {
    if (const auto one = answer(*tick)) answers.push_back(*one);
  }
  return answers;
}

std::optional<Answer> ArmController::answer(const JoinedTick& tick) {
  ++counts_.ticks;
  if (tick.new_run) {
    follower_.reset();
    last_stamp_ns_.reset();
  }
  if (!tick.joints.position) ++counts_.faulty_joints;
  if (!tick.joints.position && !follower_.started()) return std::nullopt;

  Answer answer;
  answer.stamp_ns = tick.joints.stamp_ns;
  const double dt =
      last_stamp_ns_ ? 1e-9 * static_cast<double>(tick.joints.stamp_ns - *last_stamp_ns_) : 0.0;
  last_stamp_ns_ = tick.joints.stamp_ns;

  const std::string reason = restart_reason(tick, dt);
  if (reason.empty()) {
    serve(tick, std::min(dt, params_.max_wait), answer);
  } else {
    restart(*tick.joints.position, reason, answer);
  }
  answer.command = follower_.state();
  return answer;
}

std::string ArmController::restart_reason(const JoinedTick& tick, double dt) const {
  if (!tick.joints.position) return "";
  if (!follower_.started()) return "first joint positions of the run";
  std::ostringstream text;
  if (dt > params_.max_wait) {
    text << "joint_states leapt by " << dt << " s, bound " << params_.max_wait << " s";
    return text.str();
  }
  const auto& limits = jaco_kinematics::jaco_joint_limits();
  for (int i = 0; i < 7; ++i) {
    const double error = tracking_error((*tick.joints.position)[i], follower_.state().position[i],
                                        std::isinf(limits.upper[i]));
    if (error <= params_.max_tracking_error) continue;
    text << name(i) << " is " << error << " rad from its command, bound "
         << params_.max_tracking_error << " rad";
    return text.str();
  }
  return "";
}

void ArmController::restart(const JointVector& measured, const std::string& reason,
                            Answer& answer) {
  ++counts_.restarts;
  follower_.start(measured);
  answer.restarted = true;
  answer.reason = "starts from the measured joints: " + reason;
}

void ArmController::serve(const JoinedTick& tick, double dt, Answer& answer) {
  Eigen::Isometry3d wanted;
  if (tick.joints.position && tick.setpoint && tick.setpoint->kind == SetpointKind::kPose) {
    follow(tick.setpoint->pose, dt, answer);
    wanted = tick.setpoint->pose.hand_in_base;
  } else {
    follower_.hold(dt);
    wanted = jaco_kinematics::forward(follower_.state().position);
    if (!tick.joints.position) {
      answer.reason = tick.joints.fault;
    } else if (!tick.setpoint) {
      answer.code = ControlCode::kStaleSetpoint;
      answer.reason = "no set-point for this tick";
    } else if (tick.setpoint->kind == SetpointKind::kInvalid) {
      ++counts_.invalid_setpoints;
      answer.code = ControlCode::kInvalidSetpoint;
      answer.reason = tick.setpoint->refusal;
    }
  }
  const JointVector hand = tick.joints.position.value_or(follower_.state().position);
  const auto error = pose_error(jaco_kinematics::forward(hand), wanted);
  answer.position_error = error.head<3>().norm();
  answer.orientation_error = error.tail<3>().norm();
}

void ArmController::follow(const PoseSetpoint& setpoint, double dt, Answer& answer) {
  const FollowerStep step = follower_.follow(setpoint, dt);
  if (step.goal == GoalKind::kJumpRefused) ++counts_.refused_jumps;
  if (step.goal == GoalKind::kChangesBranch) ++counts_.branch_changing;
  answer.code = code_of(step);
  answer.deviation = step.position_deviation;
  if (answer.code != ControlCode::kFollowing) answer.reason = describe(step);
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
