// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <prf_core/require.hpp>
#include <prf_core/se3.hpp>
#include <string>

#include "geometry.hpp"

namespace jaco_kinematics {

namespace {

FixedTransform make_transform(double x, double y, double z, double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Eigen::Matrix3d turn =
      (AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
       AngleAxisd(roll, Vector3d::UnitX()))
          .toRotationMatrix();
  FixedTransform result;
  result.rotation = turn.array().round();
  result.translation = Vector3d(x, y, z);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto place = static_cast<std::size_t>(i);
    turn.col(i).cwiseAbs().maxCoeff(&result.axis[place]);
    result.sign[place] = std::copysign(1.0, turn(result.axis[place], i));
  }
  return result;
}

inline Eigen::Vector3d column_after(const Eigen::Matrix3d& frame, const FixedTransform& fixed,
                                    std::size_t i) {
  return fixed.sign[i] * frame.col(fixed.axis[i]);
}

// The figures of jaco_v60_description/urdf/jaco2.xacro (the vendor's); a test compares them.
JointLimits make_limits() {
  constexpr double kDegree = kPi / 180.0;
  constexpr double kContinuous = std::numeric_limits<double>::infinity();
  JointLimits limits;
  limits.lower << -kContinuous, 47.0, -kContinuous, 30.0, -kContinuous, 65.0, -kContinuous;
  limits.upper << kContinuous, 313.0, kContinuous, 330.0, kContinuous, 295.0, kContinuous;
  limits.velocity << 36.0, 36.0, 36.0, 36.0, 48.0, 48.0, 48.0;
  limits.lower *= kDegree;
  limits.upper *= kDegree;
  limits.velocity *= kDegree;
  limits.effort << 40.0, 80.0, 40.0, 40.0, 20.0, 20.0, 20.0;
  return limits;
}

}  // namespace

// As above.
const std::array<FixedTransform, 8>& joint_origins() {
  static const std::array<FixedTransform, 8> kOrigins = {
      make_transform(0.0, 0.0, 0.15675, 0.0, kPi, 0.0),
      make_transform(0.0, 0.0016, -0.11875, -kPi / 2, 0.0, kPi),
      make_transform(0.0, -0.205, 0.0, -kPi / 2, 0.0, 0.0),
      make_transform(0.0, 0.0, -0.205, kPi / 2, 0.0, kPi),
      make_transform(0.0, 0.2073, -0.0114, -kPi / 2, 0.0, kPi),
      make_transform(0.0, 0.0, -0.10375, kPi / 2, 0.0, kPi),
      make_transform(0.0, 0.10375, 0.0, -kPi / 2, 0.0, kPi),
      make_transform(0.0, 0.0, -0.16, kPi, 0.0, kPi / 2)};
  return kOrigins;
}

const JointLimits& jaco_joint_limits() {
  static const JointLimits kLimits = make_limits();
  return kLimits;
}

bool within_limits(const JointVector& q) {
  const JointLimits& limits = jaco_joint_limits();
  return (q.array() >= limits.lower.array()).all() && (q.array() <= limits.upper.array()).all();
}

double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? wrapped + 2.0 * kPi : wrapped;
}

Eigen::Vector3d shoulder_point(double q1) {
  return {kShoulderOffset * std::sin(q1), kShoulderOffset * std::cos(q1), kShoulderHeight};
}

void check_angles(const JointVector& values, const char* name) {
  for (int i = 0; i < 7; ++i) {
    if (std::abs(values[i]) <= kLargestAngle) continue;  // false for not-a-number
    prf_core::require_between(std::string(name) + "[" + std::to_string(i) + "]", values[i],
                              -kLargestAngle, kLargestAngle, "rad");
  }
}

Eigen::Isometry3d checked_pose(const Eigen::Isometry3d& pose) {
  constexpr double kTolerance = 1e-6;  // of every entry of R^T R; float messages are within it
  prf_core::require(pose.matrix().allFinite(), "pose", pose.matrix(), "finite");
  const double farthest = pose.translation().cwiseAbs().maxCoeff();
  prf_core::require_between("the pose's farthest coordinate", farthest, 0.0, kLargestDistance, "m");
  const Eigen::Matrix3d gram = pose.linear().transpose() * pose.linear();
  const double deviation = (gram - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  prf_core::require(deviation <= kTolerance && pose.linear().determinant() > 0.0,
                    "deviation of the pose's rotation from orthonormal", deviation,
                    "<= 1e-6, and the axes right-handed");
  Eigen::Isometry3d result = pose;
  result.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return result;
}

Frames link_frames(const JointVector& q) {
  const auto& origins = joint_origins();
  Frames frames;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 7; ++i) {
    position += rotation * origins[i].translation;
    const Eigen::Vector3d x = column_after(rotation, origins[i], 0);
    const Eigen::Vector3d y = column_after(rotation, origins[i], 1);
    const Eigen::Vector3d z = column_after(rotation, origins[i], 2);
    const double c = std::cos(q[static_cast<Eigen::Index>(i)]);
    const double s = std::sin(q[static_cast<Eigen::Index>(i)]);
    rotation.col(0) = c * x + s * y;
    rotation.col(1) = c * y - s * x;
    rotation.col(2) = z;
    frames.rotation[i] = rotation;
    frames.origin[i] = position;
  }
  frames.end_effector.setIdentity();
  frames.end_effector.translation() = position + rotation * origins[7].translation;
  for (std::size_t i = 0; i < 3; ++i) {
    frames.end_effector.linear().col(static_cast<Eigen::Index>(i)) =
        column_after(rotation, origins[7], i);
  }
  return frames;
}

Jacobian jacobian(const Frames& frames) {
  Jacobian result;
  for (std::size_t i = 0; i < 7; ++i) {
    const Eigen::Vector3d axis = frames.rotation[i].col(2);
    const auto column = static_cast<Eigen::Index>(i);
    result.col(column).head<3>() = axis.cross(frames.end_effector.translation() - frames.origin[i]);
    result.col(column).tail<3>() = axis;
  }
  return result;
}

Eigen::Matrix<double, 6, 1> pose_difference(const Eigen::Isometry3d& from,
                                            const Eigen::Isometry3d& to) {
  Eigen::Matrix<double, 6, 1> difference;
  difference.head<3>() = to.translation() - from.translation();
  difference.tail<3>() =
      prf_core::log_so3(Eigen::Quaterniond(to.linear() * from.linear().transpose()));
  return difference;
}

Eigen::Isometry3d forward(const JointVector& q) {
  check_angles(q, "q");
  return link_frames(q).end_effector;
}

Jacobian jacobian(const JointVector& q) {
  check_angles(q, "q");
  return jacobian(link_frames(q));
}

}  // namespace jaco_kinematics
