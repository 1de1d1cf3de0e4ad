// SPDX-License-Identifier: BSD-3-Clause
// Poses, their velocities, and the exponential and logarithm of rotations.
//
// Metres, radians, seconds. A Pose maps coordinates of the child frame to the parent frame,
// x_parent = position + orientation * x_child (REP 103 axes). Rotation vectors are axis times
// angle; perturbations are on the left, in the parent frame: R' = Exp(r) R
// (Sola, Deray, Atchuthan 2018, "A micro Lie theory for state estimation in robotics").
#pragma once

#include <Eigen/Geometry>
#include <string>

namespace prf_core {

struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // unit

  [[nodiscard]] Eigen::Isometry3d isometry() const;  // needs a unit orientation
  [[nodiscard]] bool is_finite() const {
    return position.allFinite() && orientation.coeffs().allFinite();
  }
};

[[nodiscard]] Pose pose_from(const Eigen::Isometry3d& isometry);

// A pose with the velocity of its origin (m/s) and its angular velocity (rad/s), both in the
// parent frame.
struct MovingPose {
  Pose pose;
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();

  [[nodiscard]] bool is_finite() const {
    return pose.is_finite() && linear_velocity.allFinite() && angular_velocity.allFinite();
  }
};

// A quaternion counts as unit when its norm is within this of 1.
inline constexpr double kUnitQuaternionTolerance = 1e-3;

// Position finite and orientation unit within kUnitQuaternionTolerance; else throws
// std::invalid_argument with `name`, the value and the bound.
void require_pose(const std::string& name, const Pose& pose);

// Log: rotation vector of a unit quaternion, angle in [0, pi]. q and -q give the same vector,
// except at pi, where they give opposite ones.
[[nodiscard]] Eigen::Vector3d log_so3(const Eigen::Quaterniond& rotation);

// Exp: rotation by the angle |r| about the axis r / |r|; identity for r = 0.
[[nodiscard]] Eigen::AngleAxisd exp_so3(const Eigen::Vector3d& rotation_vector);

// Log(to from^-1): the rotation vector that turns `from` into `to`, in their common parent frame.
[[nodiscard]] Eigen::Vector3d rotation_between(const Eigen::Quaterniond& from,
                                               const Eigen::Quaterniond& to);

// Pose and velocity of a frame that is rigidly attached to the moving frame `carrier`. The result
// is in the parent frame of `carrier`.
[[nodiscard]] MovingPose rigidly_attached(const MovingPose& carrier, const Pose& frame_in_carrier);

// The moving pose `time` seconds after `start`, where `end` is `span` seconds after `start`. The
// caller sees to span > 0 and 0 <= time <= span; neither is checked. The position follows the cubic
// Hermite polynomial of the two positions and linear velocities. The orientation turns along the
// shortest great arc (slerp) at constant angular velocity, whatever angular velocities `start` and
// `end` have.
[[nodiscard]] MovingPose interpolate(const MovingPose& start, const MovingPose& end, double span,
                                     double time);

}  // namespace prf_core
