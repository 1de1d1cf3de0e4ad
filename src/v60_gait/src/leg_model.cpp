// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/leg_model.hpp"

#include <algorithm>
#include <stdexcept>

namespace v60_gait {
namespace {

constexpr double kReached = 1e-12;  // m
constexpr int kMaxIterations = 50;

int body_of_joint(const RigidTree& robot, const std::string& name) {
  const auto found = std::find_if(robot.joints.begin(), robot.joints.end(),
                                  [&](const RobotJoint& joint) { return joint.name == name; });
  if (found != robot.joints.end()) return found->body;
  throw std::invalid_argument("robot description has no movable joint '" + name +
                              "', must have it");
}

}  // namespace

LegModel::LegModel(const RigidTree& robot, const std::string& name) : name_(name) {
  int parent = 0;
  std::size_t i = 0;
  for (const char* joint : {"_abduction", "_hip", "_knee"}) {
    const int body = body_of_joint(robot, name + joint);
    const RigidBody& moved = robot.bodies[static_cast<std::size_t>(body)];
    if (moved.parent != parent) {
      throw std::invalid_argument("joints of leg '" + name +
                                  "' are no chain on base_link, must be");
    }
    segments_[i++] = {moved.joint_in_parent, moved.axis, moved.mass, moved.centre_of_mass};
    parent = body;
  }
  const auto toe = robot.links.find(name + "_toe");
  if (toe == robot.links.end() || toe->second.body != parent) {
    throw std::invalid_argument("link '" + name + "_toe' is not fixed to the lower leg, must be");
  }
  toe_in_lower_ = toe->second.pose.translation();
}

std::array<Eigen::Isometry3d, 3> LegModel::segment_poses(const Eigen::Vector3d& angles) const {
  std::array<Eigen::Isometry3d, 3> poses;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const double angle = angles[static_cast<Eigen::Index>(i)];
    pose = pose * segments_[i].joint * Eigen::AngleAxisd(angle, segments_[i].axis);
    poses[i] = pose;
  }
  return poses;
}

Eigen::Vector3d LegModel::toe(const Eigen::Vector3d& angles) const {
  return segment_poses(angles)[2] * toe_in_lower_;
}

// Column i: axis_i x (toe - pivot_i). A joint's axis and pivot are fixed in the segment it moves.
Eigen::Matrix3d LegModel::jacobian(const Eigen::Vector3d& angles) const {
  const auto poses = segment_poses(angles);
  const Eigen::Vector3d end = poses[2] * toe_in_lower_;
  Eigen::Matrix3d jacobian;
  for (std::size_t i = 0; i < 3; ++i) {
    jacobian.col(static_cast<Eigen::Index>(i)) =
        (poses[i].linear() * segments_[i].axis).cross(end - poses[i].translation());
  }
  return jacobian;
}

// tau_i = -axis_i . sum over the segments j from i on of (centre_j - pivot_i) x m_j g.
Eigen::Vector3d LegModel::weight_torques(const Eigen::Vector3d& angles,
                                         const Eigen::Vector3d& gravity) const {
  const auto poses = segment_poses(angles);
  Eigen::Vector3d torques;
  for (std::size_t i = 0; i < 3; ++i) {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (std::size_t j = i; j < 3; ++j) {
      const Eigen::Vector3d lever = poses[j] * segments_[j].centre_of_mass - poses[i].translation();
      moment += segments_[j].mass * lever.cross(gravity);
    }
    torques[static_cast<Eigen::Index>(i)] = -(poses[i].linear() * segments_[i].axis).dot(moment);
  }
  return torques;
}

Eigen::Vector3d LegModel::angles(const Eigen::Vector3d& toe_position,
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

}  // namespace v60_gait
