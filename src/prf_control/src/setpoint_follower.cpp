// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/setpoint_follower.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <prf_core/se3.hpp>
#include <stdexcept>
#include <utility>

#include "prf_control/measured_joints.hpp"
#include "prf_control/nearest_pose.hpp"
#include "prf_control/resolved_rate.hpp"

namespace prf_control {
namespace {

using arm_kinematics::IkResult;
using ErrorVector = Eigen::Matrix<double, 6, 1>;

// The constants below are ours; the tests named say what they achieve.

// [rad] of every joint: the change of branch is over. (test_branch_change)
constexpr double kArrived = 0.02;
// The resolved-rate step corrects the error e of the hand with the velocity
// min(kCatchUpRate, sqrt(2 kCatchUpAcceleration / e)) e: exponentially near the set-point, and so
// that a braking at kCatchUpAcceleration ends there from afar. An orientation counts for
// orientation_weight metres a radian. (test_setpoint_follower, KeepsTheHandOnItsWay...)
constexpr double kCatchUpRate = 12.0;         // [1/s]; the ticks come at 100 Hz
constexpr double kCatchUpAcceleration = 1.0;  // [m/s^2]
// [1/s] Rate at which the null-space objective draws the joints to those of the goal.
constexpr double kNullSpaceRate = 2.0;
// [rad] A joint that is farther outside its limits than rounding goes back inside.
constexpr double kOutside = 1e-9;

MotionLimits limits_of(const arm_kinematics::JointLimits& joints, const FollowerParams& params,
                       double braking) {
  const auto most = [&](double acceleration) -> JointVector {
    return joints.acceleration.cwiseMin(acceleration);
  };
  MotionLimits limits{joints.lower, joints.upper, params.velocity_scale * joints.velocity,
                      most(params.acceleration), most(braking)};
  limits.validate();
  return limits;
}

Eigen::Isometry3d moved_back(const PoseSetpoint& setpoint, double dt) {
  Eigen::Isometry3d pose = setpoint.hand_in_base;
  pose.translation() -= setpoint.linear_velocity * dt;
  pose.linear() =
      prf_core::exp_so3(-setpoint.angular_velocity * dt).toRotationMatrix() * pose.linear();
  return pose;
}

}  // namespace

struct SetpointFollower::Goal {
  GoalKind kind;
  MotionState motion;
  int jump_joint;
  double jump;
};

void FollowerParams::validate() const {
  using prf_core::require_between;
  require_between("velocity_scale", velocity_scale, 0.01, 1.0);
  require_between("acceleration", acceleration, 0.1, 20.0, "rad/s^2");
  require_between("max_joint_step", max_joint_step, 0.01, 1.0, "rad");
  require_between("far_position", far_position, 0.001, 1.0, "m");
  require_between("far_orientation", far_orientation, 0.001, M_PI, "rad");
  require_between("damping", damping, 0.001, 1.0);
  require_between("orientation_weight", orientation_weight, 0.01, 10.0, "m/rad");
  require_between("branch_patience", branch_patience, 0.01, 60.0, "s");
}

SetpointFollower::SetpointFollower(Arm arm, const FollowerParams& params) : arm_(std::move(arm)) {
  if (!arm_) throw std::invalid_argument("a follower needs an arm");
  tune(params);
}

void SetpointFollower::tune(const FollowerParams& params) {
  params.validate();
  params_ = params;
  braking_ = std::max(braking_, params.acceleration);
  limits_ = limits_of(arm_->limits(), params_, braking_);
}

void SetpointFollower::start(const JointVector& measured) { start(at_rest(measured)); }

void SetpointFollower::start(const MotionState& state) {
  if (!state.position.allFinite() || !state.velocity.allFinite()) {
    throw std::invalid_argument("joints to start from must be finite");
  }
  reset();
  state_ = state;
}

void SetpointFollower::move_by_turns(const JointVector& turns) {
  state_.value().position += turns;
  if (goal_) *goal_ += turns;
}

void SetpointFollower::reset() {
  state_.reset();
  forget_setpoints();
}

void SetpointFollower::forget_setpoints() {
  goal_.reset();
  last_pose_.reset();
  refused_for_ = 0;
  changes_branch_ = false;
  transfers_ = false;
  drift_speed_ = 0;
}

FollowerStep SetpointFollower::follow(const PoseSetpoint& setpoint, double dt) {
  FollowerStep step;
  if ((joints_outside(state().position, arm_->limits()).array() > kOutside).any()) {
    step = step_inside(dt);
  } else {
    step = step_toward_goal(setpoint, choose_goal(setpoint, dt), dt);
  }
  const ErrorVector deviation =
      pose_error(arm_->forward(step.motion.state.position), setpoint.hand_in_base);
  step.position_deviation = deviation.head<3>().norm();
  step.orientation_deviation = deviation.tail<3>().norm();
  state_ = step.motion.state;
  return step;
}

FollowerStep SetpointFollower::step_inside(double dt) {
  FollowerStep step;
  step.goal = GoalKind::kInside;
  step.jump = joints_outside(state().position, arm_->limits()).maxCoeff(&step.jump_joint);
  MotionLimits limits = limits_;
  limits.velocity *= kSlowly;
  const JointVector inside = state().position.cwiseMax(limits.lower).cwiseMin(limits.upper);
  step.motion = step_toward(state(), at_rest(inside), dt, limits);
  forget_setpoints();
  return step;
}

FollowerStep SetpointFollower::step_toward_goal(const PoseSetpoint& setpoint, const Goal& goal,
                                                double dt) {
  FollowerStep step;
  step.goal = goal.kind;
  step.jump_joint = goal.jump_joint;
  step.jump = goal.jump;
  MotionLimits limits = limits_;
  if (goal.kind == GoalKind::kChangesBranch) limits.velocity *= kSlowly;
  step.motion = step_toward(state(), goal.motion, dt, limits);
  transfers_ = transfers_ && step.motion.limit != Limit::kNone;
  if (goal.kind == GoalKind::kExact && !transfers_ && step.motion.limit != Limit::kNone) {
    step.motion = resolved_rate_step(setpoint, goal.motion, dt);
  }
  goal_ = goal.motion.position;
  last_pose_ = setpoint.hand_in_base;
  return step;
}

FollowerStep SetpointFollower::hold(double dt) {
  FollowerStep step;
  step.motion = step_to_rest(state(), dt, limits_);
  state_ = step.motion.state;
  forget_setpoints();
  return step;
}

LimitedStep SetpointFollower::resolved_rate_step(const PoseSetpoint& setpoint,
                                                 const MotionState& goal, double dt) const {
  const JointVector& q = state().position;
  const ErrorVector error = pose_error(arm_->forward(q), moved_back(setpoint, dt));
  ErrorVector twist;
  twist << setpoint.linear_velocity, setpoint.angular_velocity;
  const double size =
      std::hypot(error.head<3>().norm(), params_.orientation_weight * error.tail<3>().norm());
  const double rate = std::min(kCatchUpRate, std::sqrt(2.0 * kCatchUpAcceleration / size));
  const JointVector null_space_velocity =
      goal.velocity + kNullSpaceRate * (goal.position - goal.velocity * dt - q);
  const JointVector velocity =
      resolved_rate({arm_->jacobian(q), twist + rate * error,
                     null_space_velocity.cwiseMax(-limits_.velocity).cwiseMin(limits_.velocity),
                     params_.orientation_weight},
                    allowed_velocities(state(), dt, limits_));
  LimitedStep step{moved(state(), velocity, dt, limits_), Limit::kAcceleration, -1, 0.0, 0.0};
  const JointVector asked = null_space_velocity.cwiseAbs().cwiseQuotient(limits_.velocity);
  for (int i = 0; i < velocity.size(); ++i) {
    const bool at_limit = std::abs(velocity[i]) >= limits_.velocity[i];
    if (at_limit && (step.joint < 0 || asked[i] > asked[step.joint])) {
      step.limit = Limit::kVelocity;
      step.joint = i;
      step.asked = null_space_velocity[i];
      step.bound = limits_.velocity[i];
    }
  }
  return step;
}

SetpointFollower::Goal SetpointFollower::choose_goal(const PoseSetpoint& setpoint, double dt) {
  const Eigen::Isometry3d& pose = setpoint.hand_in_base;
  const bool far = is_far(pose);
  transfers_ = transfers_ || far;
  const JointVector reference = far || !goal_ ? state().position : *goal_;
  const auto jumps = [&](const JointVector& q) {
    return (q - reference).cwiseAbs().maxCoeff() > params_.max_joint_step;
  };

  // First the solution nearest to the command; where that jumps, the one nearest to the last goal.
  const JointVector drift = posture_drift(dt);
  IkResult solution = arm_->inverse(pose, state().position + drift * dt);
  if (solution.solved && jumps(solution.q)) {
    solution = arm_->inverse(pose, reference);
  }
  const bool solved = solution.solved;
  const JointVector q =
      solved ? solution.q : nearest_pose(*arm_, pose, reference, params_.orientation_weight);

  int joint = 0;
  const double jump = (q - reference).cwiseAbs().maxCoeff(&joint);
  const bool refused = !far && jumps(q);
  refused_for_ = refused ? refused_for_ + dt : 0;
  if (refused && refused_for_ < params_.branch_patience) {
    const JointVector crept = damped_step(pose, reference, dt);
    const auto kind = changes_branch_ ? GoalKind::kChangesBranch : GoalKind::kJumpRefused;
    return {kind, {crept, (crept - reference) / dt}, joint, jump};
  }
  const double to_go = (q - state().position).cwiseAbs().maxCoeff(&joint);
  changes_branch_ = (refused || changes_branch_) && !far && to_go > kArrived;
  if (changes_branch_) return {GoalKind::kChangesBranch, at_rest(q), joint, to_go};
  if (!solved) return {GoalKind::kNearest, at_rest(q), -1, 0.0};
  return {GoalKind::kExact, {q, goal_velocity(setpoint, q, dt) + drift}, -1, 0.0};
}

// Not on the way to a far set-point and to another branch, where all joints go together.
JointVector SetpointFollower::posture_drift(double dt) {
  const bool drifts = !transfers_ && !changes_branch_;
  const double change = kPostureAcceleration * dt;
  drift_speed_ += std::clamp((drifts ? kPostureSpeed : 0.0) - drift_speed_, -change, change);
  return drift_speed_ * arm_->posture_motion(state().position);
}

// Zero where the pose of one period ago has no solution near the goal.
JointVector SetpointFollower::goal_velocity(const PoseSetpoint& setpoint, const JointVector& goal,
                                            double dt) const {
  if (setpoint.linear_velocity.isZero(0.0) && setpoint.angular_velocity.isZero(0.0)) {
    return JointVector::Zero(goal.size());
  }
  const IkResult before = arm_->inverse(moved_back(setpoint, dt), goal, {0, true});
  const JointVector step = goal - before.q;
  const bool continuous = before.solved && step.cwiseAbs().maxCoeff() <= params_.max_joint_step;
  return continuous ? JointVector(step / dt) : JointVector::Zero(goal.size());
}

// Damped least squares with the position in units of orientation_weight:
//   dq = A^T (A A^T + damping^2 I)^-1 e,  A = W J,  shortened to the velocity limits.
JointVector SetpointFollower::damped_step(const Eigen::Isometry3d& hand_in_base,
                                          const JointVector& from, double dt) const {
  ErrorVector weight;
  weight << Eigen::Vector3d::Constant(1.0 / params_.orientation_weight), Eigen::Vector3d::Ones();
  const ErrorVector error = pose_error(arm_->forward(from), hand_in_base).cwiseProduct(weight);
  const arm_kinematics::Jacobian a = weight.asDiagonal() * arm_->jacobian(from);
  Eigen::Matrix<double, 6, 6> normal = a * a.transpose();
  normal.diagonal().array() += params_.damping * params_.damping;
  const JointVector dq = a.transpose() * normal.ldlt().solve(error);

  const double excess = dq.cwiseAbs().cwiseQuotient(limits_.velocity * dt).maxCoeff();
  const JointVector step = dq / std::max(1.0, excess);
  return (from + step).cwiseMax(limits_.lower).cwiseMin(limits_.upper);
}

bool SetpointFollower::is_far(const Eigen::Isometry3d& hand_in_base) const {
  const Eigen::Isometry3d last = last_pose_ ? *last_pose_ : arm_->forward(state().position);
  const ErrorVector error = pose_error(last, hand_in_base);
  return error.head<3>().norm() > params_.far_position ||
         error.tail<3>().norm() > params_.far_orientation;
}

}  // namespace prf_control
