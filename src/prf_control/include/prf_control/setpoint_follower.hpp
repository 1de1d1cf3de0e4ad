// SPDX-License-Identifier: BSD-3-Clause
// From a moving pose of the hand to joint positions and velocities, one control period at a time.
//
//   goal      q_g = inverse(T), the solution nearest to the joints as they are, drifting by
//             kNullSpaceSpeed at most away from limits and singularities;
//             T out of reach: the nearest pose (nearest_pose.hpp);
//             a jump of a joint by more than max_joint_step, though T moved little (a change of
//             branch): refused, the goal takes a damped step along the Jacobian instead; refused
//             for branch_patience without a break: made after all, at kBranchChangeSpeed
//   velocity  dq_g = (q_g - inverse(T moved back by its twist)) / dt
//   command   the step of joint_motion.hpp toward (q_g, dq_g); where a limit would shape it, the
//             joints that are left keep the hand on its way (resolved_rate.hpp), but for a
//             set-point far from the last one, to which all joints go together
//
// The follower's own last command is its state; it starts from measured joints, at rest. A
// set-point reached within the limits is met exactly: forward(command) = T.
// Frames: everything of the hand (j2s7s300_end_effector) in j2s7s300_link_base; m, rad, s.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "prf_control/joint_motion.hpp"

namespace prf_control {

struct FollowerParams {
  double velocity_scale;      // share of the URDF's joint velocity limits, (0, 1]
  double acceleration;        // [rad/s^2] of every joint, > 0
  double max_joint_step;      // [rad], > 0
  double far_position;        // [m], > 0; a set-point farther from the last one is a new task
  double far_orientation;     // [rad], > 0, < pi; likewise
  double damping;             // of the Jacobian step, (0, 1]
  double orientation_weight;  // [m/rad], > 0; see nearest_pose.hpp
  double branch_patience;     // [s], > 0; for which a change of branch is refused

  void validate() const;
};

// Share of the velocity limits that a change of branch may use: the hand leaves its path meanwhile.
inline constexpr double kBranchChangeSpeed = 0.25;

// Speed of the self-motion toward a better posture, norm of all joints; slower where the
// acceleration limit asks for it, so that the drift can start and end within one period.
inline constexpr double kNullSpaceSpeed = 0.04;  // [rad/s]

struct PoseSetpoint {
  Eigen::Isometry3d hand_in_base = Eigen::Isometry3d::Identity();
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();   // [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // [rad/s]
};

enum class GoalKind {
  kExact,          // forward(goal) is the set-point
  kNearest,        // out of reach or limits, the goal is the nearest pose
  kJumpRefused,    // a change of branch refused, the goal creeps toward the set-point
  kChangesBranch,  // on the way to another branch, slowly
  kRest            // hold
};

struct FollowerStep {
  GoalKind goal = GoalKind::kRest;
  LimitedStep motion;                // the command, and what slowed it
  double position_deviation = 0;     // [m], set-point to forward(command); 0 when holding
  double orientation_deviation = 0;  // [rad]
  int jump_joint = -1;               // the joint whose jump was refused, or farthest to go
  double jump = 0;                   // [rad]
};

class SetpointFollower {
 public:
  explicit SetpointFollower(const FollowerParams& params);

  // At rest at `measured`, moved inside the joint limits; forgets everything else.
  void start(const JointVector& measured);
  void reset();
  [[nodiscard]] bool started() const { return state_.has_value(); }
  [[nodiscard]] const MotionState& state() const { return state_.value(); }

  // Other parameters from the next step on; a motion above new velocity limits brakes down to them.
  void tune(const FollowerParams& params);

  // Both need started(); std::invalid_argument for non-finite set-points or dt <= 0.
  FollowerStep follow(const PoseSetpoint& setpoint, double dt);
  FollowerStep hold(double dt);

 private:
  struct Goal;
  Goal choose_goal(const PoseSetpoint& setpoint, double dt);
  jaco_kinematics::IkParams ik_params(double dt) const;
  void forget_set_points();
  LimitedStep resolved_rate_step(const PoseSetpoint& setpoint, const MotionState& goal,
                                 double dt) const;
  JointVector goal_velocity(const PoseSetpoint& setpoint, const JointVector& goal, double dt) const;
  JointVector damped_step(const Eigen::Isometry3d& hand_in_base, const JointVector& from,
                          double dt) const;
  bool is_far(const Eigen::Isometry3d& hand_in_base) const;

  FollowerParams params_;
  MotionLimits limits_;
  std::optional<MotionState> state_;
  std::optional<JointVector> goal_;             // of the last follow(), none after a hold
  std::optional<Eigen::Isometry3d> last_pose_;  // the last set-point, none after a hold
  double refused_for_ = 0;                      // [s], a change of branch, without a break
  bool changes_branch_ = false;
  bool transfers_ = false;  // toward a set-point that was far from the one before
};

}  // namespace prf_control
