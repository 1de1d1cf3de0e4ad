// SPDX-License-Identifier: BSD-3-Clause
// The arm as data, and the frames of a configuration. Private to the library.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "jaco_kinematics/jaco_kinematics.hpp"

namespace jaco_kinematics {

constexpr double kPi = 3.14159265358979323846;

// Metres, sums of the joint origins in jaco_v60_description/urdf/jaco2.xacro (the vendor's
// figures). Axes 2 and 3 meet in the shoulder point S = (0, 0, kShoulderHeight)
// + kShoulderOffset (sin q1, cos q1, 0); axes 5, 6 and 7 meet in the wrist centre W.
// In the elbow frame (axis 4 = z, forearm along y) W = (0, kForearm, kElbowOffset).
constexpr double kShoulderHeight = 0.2755;
constexpr double kShoulderOffset = 0.0016;
constexpr double kUpperArm = 0.41;
constexpr double kForearm = 0.31105;
constexpr double kElbowOffset = -0.0114;
constexpr double kToolLength = 0.26375;  // from W along the tool axis

// All origins turn by right angles: column i of the rotation is sign[i] times the unit vector
// axis[i].
struct FixedTransform {
  Eigen::Matrix3d rotation;
  std::array<Eigen::Index, 3> axis;
  std::array<double, 3> sign;
  Eigen::Vector3d translation;
};

// Origins of joints 1 to 7 in their parent links, then of the end effector in link 7.
const std::array<FixedTransform, 8>& joint_origins();

// Link frames 1 to 7 at [0] to [6], all in link_base; joint i turns about z of frame i. S, the
// elbow and W are the origins of joints 2, 4 and 6.
struct Frames {
  std::array<Eigen::Matrix3d, 7> rotation;
  std::array<Eigen::Vector3d, 7> origin;
  Eigen::Isometry3d end_effector;
};
Frames link_frames(const JointVector& q);
Jacobian jacobian(const Frames& frames);

// Difference of a pose to another: translation, then the rotation vector, both in link_base.
Eigen::Matrix<double, 6, 1> pose_difference(const Eigen::Isometry3d& from,
                                            const Eigen::Isometry3d& to);

Eigen::Vector3d shoulder_point(double q1);

// Into (-pi, pi].
double wrap_angle(double angle);

inline bool is_limited(int joint) { return joint == 1 || joint == 3 || joint == 5; }
bool within_limits(const JointVector& q);

// The pose with its rotation made orthonormal; std::invalid_argument if it is no rotation or the
// place is beyond kLargestDistance.
Eigen::Isometry3d checked_pose(const Eigen::Isometry3d& pose);
void check_angles(const JointVector& values, const char* name);

}  // namespace jaco_kinematics
