// SPDX-License-Identifier: BSD-3-Clause
// What everything between camera and joints asks of an arm, whatever arm it is. Implementations:
// ChainKinematics (chain_kinematics.hpp), any serial chain of a URDF, and JacoArm of
// jaco_kinematics, a closed form.
//
//   forward:  T(q)  pose of the tip in the base
//   jacobian: J(q)  geometric, of the tip in the base, linear rows first
//   inverse:  q     within limits with T(q) = pose, beginning at a seed
//   nearest:  q     within limits whose T(q) is nearest to a pose that cannot be reached
//
// Metres and radians; a prismatic joint counts in metres. The functions are pure: what they return
// depends on their arguments alone. They throw std::invalid_argument for input that is not finite
// or of the wrong size. Joints outside their limits are no error.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace arm_kinematics {

inline constexpr int kMaxJoints = 8;

using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxJoints, 1>;
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxJoints>;
using Twist = Eigen::Matrix<double, 6, 1>;  // linear rows first

struct JointLimits {
  JointVector lower;     // [rad] or [m], -infinity where the joint is continuous
  JointVector upper;     // [rad] or [m], +infinity where the joint is continuous
  JointVector velocity;  // [rad/s] or [m/s], > 0
  JointVector effort;    // [N m] or [N]
  // [rad/s^2] or [m/s^2], > 0; +infinity where nothing is known. A URDF does not have it.
  JointVector acceleration;
};

// What of a pose the arm follows.
enum class Task {
  kPose,             // position and orientation: 6 joints or more
  kPositionAndAxis,  // position and direction of the tip's z axis: 5 joints
};

// How far a pose is from another one, as far as the task asks for it.
struct PoseError {
  double position = 0.0;     // [m]
  double orientation = 0.0;  // [rad], for kPositionAndAxis the angle between the z axes
};

struct Placement {
  Eigen::Isometry3d tip;  // in the base
  Jacobian jacobian;
};

// How inverse() seeks.
struct IkSearch {
  std::uint64_t draws = 0;  // seed of the random numbers for other places to begin at
  // The solution nearest to the seed, however close to a limit, and none from another place.
  bool nearest = false;
};

struct IkResult {
  bool solved = false;  // both errors below 1e-9
  JointVector q;        // if not solved: the seed
  PoseError error;      // of q
};

class ArmKinematics {
 public:
  virtual ~ArmKinematics() = default;
  ArmKinematics(const ArmKinematics&) = delete;
  ArmKinematics& operator=(const ArmKinematics&) = delete;

  [[nodiscard]] virtual const JointLimits& limits() const = 0;
  [[nodiscard]] virtual Eigen::Isometry3d forward(const JointVector& q) const = 0;
  [[nodiscard]] virtual Placement placement(const JointVector& q) const = 0;

  // The solution that a search from the seed finds; where it finds none, one from another place,
  // the first that is found. Continuous joints, and joints of more than a turn, are in the turn
  // nearest to the seed that their limits allow.
  [[nodiscard]] virtual IkResult inverse(const Eigen::Isometry3d& pose, const JointVector& seed,
                                         const IkSearch& options = {}) const = 0;

  // Whether any joints within limits give the pose.
  [[nodiscard]] virtual bool reaches(const Eigen::Isometry3d& pose) const;

  // A local minimum over the limits of
  //   |p(q) - p|^2 + (orientation_weight angle(R(q), R))^2
  // beginning at `start`, and never worse than it. orientation_weight [m/rad] > 0.
  [[nodiscard]] JointVector nearest(const Eigen::Isometry3d& pose, const JointVector& start,
                                    double orientation_weight) const;

  [[nodiscard]] Jacobian jacobian(const JointVector& q) const { return placement(q).jacobian; }
  [[nodiscard]] int joint_count() const { return static_cast<int>(limits().lower.size()); }
  [[nodiscard]] Task task() const {
    return joint_count() < 6 ? Task::kPositionAndAxis : Task::kPose;
  }

  // Redundancy objective: a joint motion of norm below 1 that leaves the task alone, to first
  // order, and takes the arm to a preferred posture; here toward the middle between the limits.
  // Added to a seed, it moves the next solution that way. 0 for an arm without redundancy.
  [[nodiscard]] virtual JointVector posture_motion(const JointVector& q) const;

  // The part of a wanted joint motion that leaves the task alone, to first order. 0 for an arm
  // without redundancy.
  [[nodiscard]] JointVector self_motion(const JointVector& q, const JointVector& wanted) const;

  // Between the limits of each joint; 0 where it has none.
  [[nodiscard]] JointVector middle() const;

 protected:
  ArmKinematics() = default;
  void require_joints(const JointVector& q, const char* name) const;
};

[[nodiscard]] PoseError error_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to,
                                      Task task);

}  // namespace arm_kinematics
