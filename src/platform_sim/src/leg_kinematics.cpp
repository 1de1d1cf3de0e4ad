// SPDX-License-Identifier: BSD-3-Clause
#include "leg_kinematics.hpp"

#include <algorithm>
#include <stdexcept>

namespace platform_sim {
namespace {

constexpr double kReached = 1e-12;  // m
constexpr int kMaxIterations = 50;

int body_of_joint(const RigidTree& robot, const std::string& name) {
  const auto found = std::find_if(robot.joints.begin(), robot.joints.end(),
                                  [&](const RobotJoint& joint) { return joint.name == name; });
  if (found != robot.joints.end()) return found->body;
  throw std::invalid_argument("robot description has no movable joint '" + name + "'");
}

}  // namespace

LegKinematics::LegKinematics(const RigidTree& robot, const std::string& name) : name_(name) {
  int parent = 0;
  std::size_t i = 0;
  for (const char* joint : {"_abduction", "_hip", "_knee"}) {
    const int body = body_of_joint(robot, name + joint);
    const RigidBody& moved = robot.bodies[static_cast<std::size_t>(body)];
    if (moved.parent != parent) {
      throw std::invalid_argument("joints of leg '" + name + "' are no chain on base_link");
    }
    origins_[i] = moved.joint_in_parent;
    axes_[i++] = moved.axis;
    parent = body;
  }
  const auto toe = robot.links.find(name + "_toe");
  if (toe == robot.links.end() || toe->second.body != parent) {
    throw std::invalid_argument("link '" + name + "_toe' is not fixed to the lower leg");
  }
  toe_in_lower_ = toe->second.pose.translation();
}

Eigen::Vector3d LegKinematics::toe(const Eigen::Vector3d& angles) const {
  Eigen::Vector3d point = toe_in_lower_;
  for (int i = 2; i >= 0; --i) {
    const auto joint = static_cast<std::size_t>(i);
    point = origins_[joint] * (Eigen::AngleAxisd(angles[i], axes_[joint]) * point);
  }
  return point;
}

// Column i: axis_i x (toe - pivot_i), in base_link.
Eigen::Matrix3d LegKinematics::jacobian(const Eigen::Vector3d& angles) const {
  const Eigen::Vector3d end = toe(angles);
  Eigen::Matrix3d jacobian;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    frame = frame * origins_[joint];
    jacobian.col(i) = (frame.linear() * axes_[joint]).cross(end - frame.translation());
    frame = frame * Eigen::AngleAxisd(angles[i], axes_[joint]);
  }
  return jacobian;
}

Eigen::Vector3d LegKinematics::angles(const Eigen::Vector3d& toe_position,
                                      const Eigen::Vector3d& start) const {
  Eigen::Vector3d angles = start;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Eigen::Vector3d error = toe_position - toe(angles);
    if (error.norm() < kReached) return angles;
    angles += jacobian(angles).fullPivLu().solve(error);
  }
  throw std::invalid_argument("leg '" + name_ +
                              "' of the robot description cannot reach its stance");
}

}  // namespace platform_sim
