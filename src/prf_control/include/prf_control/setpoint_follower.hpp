// SPDX-License-Identifier: BSD-3-Clause
// Follows a moving pose of the hand with joint positions and velocities, one control period at a
// time.
//
//   goal      q_g = inverse(T), the solution nearest to the command;
//             T out of reach: the nearest pose (nearest_pose.hpp);
//             a joint of q_g jumps by more than max_joint_step though T moved little (a change of
//             branch): refused, the goal takes a damped step along the Jacobian instead; after
//             branch_patience of refusals the branch is changed, at kSlowly
//   velocity  dq_g = (q_g - inverse(T moved back by its twist)) / dt
//   command   the step of joint_motion.hpp toward (q_g, dq_g). Where a limit shapes that step, a
//             resolved-rate step (resolved_rate.hpp) keeps the hand on its path instead; but to a
//             set-point far from the last one all joints go together
//
// While the command is on its goal, the redundancy drifts away from limits and singularities
// (posture_motion of the arm's kinematics). The state is the last command; start() sets it to
// measured joints at rest. From outside the joint limits the arm first goes back inside, at
// kSlowly; hold() leaves it where it is. A set-point that is reached within the limits is met
// exactly: forward(command) = T. The hand is the tip of the arm's kinematics, its pose and twist
// are in their base; m, rad, s.
#pragma once

#include <Eigen/Geometry>
#include <arm_kinematics/arm_kinematics.hpp>
#include <memory>
#include <optional>

#include "prf_control/joint_motion.hpp"

namespace prf_control {

using Arm = std::shared_ptr<const arm_kinematics::ArmKinematics>;

struct FollowerParams {
  double velocity_scale;      // share of the URDF's joint velocity limits, 0.01 to 1
  double acceleration;        // [rad/s^2] of every joint, 0.1 to 20; less where the arm allows less
  double max_joint_step;      // [rad], 0.01 to 1
  double far_position;        // [m], 0.001 to 1; from the last set-point; beyond it all joints go
                              // together
  double far_orientation;     // [rad], 0.001 to pi; likewise
  double damping;             // of the Jacobian step, 0.001 to 1
  double orientation_weight;  // [m/rad], 0.01 to 10; see nearest_pose.hpp
  double branch_patience;     // [s], 0.01 to 60; for which a change of branch is refused

  void validate() const;
};

// Share of the velocity limits for a change of branch (of the inverse kinematics) and for the way
// back inside the joint limits. The motion is slow because the hand leaves its path meanwhile.
inline constexpr double kSlowly = 0.25;

// [rad/s], [rad/s^2] Greatest speed of the drift to the preferred posture, norm of all joints, and
// how it comes up. docs/results/kinematics.md says what the drift gains.
inline constexpr double kPostureSpeed = 0.6;
inline constexpr double kPostureAcceleration = 0.5;

struct PoseSetpoint {
  Eigen::Isometry3d hand_in_base = Eigen::Isometry3d::Identity();
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();   // [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // [rad/s]
};

enum class GoalKind {
  kExact,          // forward(goal) is the set-point
  kNearest,        // out of reach or limits, the goal is the nearest pose
  kJumpRefused,    // a change of branch refused, the goal takes damped steps to the set-point
  kChangesBranch,  // on the way to another branch, slowly
  kInside,         // from outside the joint limits to the nearest joint positions inside, slowly
  kRest            // hold
};

struct FollowerStep {
  GoalKind goal = GoalKind::kRest;
  LimitedStep motion;                // the command, and the limit that shaped it
  double position_deviation = 0;     // [m], set-point to forward(command); 0 when holding
  double orientation_deviation = 0;  // [rad]
  // Joint of the refused jump, the farthest from its goal while the branch changes, or the farthest
  // outside its limits.
  int jump_joint = -1;
  double jump = 0;  // [rad]
};

class SetpointFollower {
 public:
  // std::invalid_argument for parameters that validate() refuses, and without an arm.
  SetpointFollower(Arm arm, const FollowerParams& params);

  // At rest at `measured`, also outside the joint limits; forgets everything else.
  void start(const JointVector& measured);
  void start(const MotionState& state);
  // The same motion with the joints this much farther, whole turns of continuous joints [rad].
  void move_by_turns(const JointVector& turns);
  void reset();  // as constructed: not started
  [[nodiscard]] bool started() const { return state_.has_value(); }
  [[nodiscard]] const MotionState& state() const { return state_.value(); }

  [[nodiscard]] const MotionLimits& limits() const { return limits_; }
  [[nodiscard]] const arm_kinematics::ArmKinematics& arm() const { return *arm_; }

  // Other parameters from the next step on, std::invalid_argument if validate() refuses them; a
  // motion above new velocity limits brakes down to them. Braking uses the greatest acceleration
  // that was ever given: no tuning makes a motion under way harder to stop.
  void tune(const FollowerParams& params);

  // Both need started(); std::invalid_argument for non-finite set-points or dt <= 0.
  FollowerStep follow(const PoseSetpoint& setpoint, double dt);
  FollowerStep hold(double dt);

 private:
  struct Goal;
  Goal choose_goal(const PoseSetpoint& setpoint, double dt);
  FollowerStep step_toward_goal(const PoseSetpoint& setpoint, const Goal& goal, double dt);
  FollowerStep step_inside(double dt);
  JointVector posture_drift(double dt);
  void forget_setpoints();
  LimitedStep resolved_rate_step(const PoseSetpoint& setpoint, const MotionState& goal,
                                 double dt) const;
  JointVector goal_velocity(const PoseSetpoint& setpoint, const JointVector& goal, double dt) const;
  JointVector damped_step(const Eigen::Isometry3d& hand_in_base, const JointVector& from,
                          double dt) const;
  bool is_far(const Eigen::Isometry3d& hand_in_base) const;

  Arm arm_;
  FollowerParams params_;
  double braking_ = 0.0;  // [rad/s^2]
  MotionLimits limits_;
  std::optional<MotionState> state_;
  std::optional<JointVector> goal_;             // of the last follow(), none after a hold
  std::optional<Eigen::Isometry3d> last_pose_;  // the last set-point, none after a hold
  double refused_for_ = 0;                      // [s], a change of branch, without a break
  bool changes_branch_ = false;
  bool transfers_ = false;  // on the way to a set-point that was far from the one before
  double drift_speed_ = 0;  // [rad/s]
};

}  // namespace prf_control
