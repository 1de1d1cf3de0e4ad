// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/frame_tree.hpp"

#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <prf_core/bounds.hpp>
#include <prf_core/quoted.hpp>
#include <stdexcept>

namespace prf_ros {
namespace {

Eigen::Isometry3d to_isometry(const urdf::Pose& pose) {
  Eigen::Quaterniond rotation;
  pose.rotation.getQuaternion(rotation.x(), rotation.y(), rotation.z(), rotation.w());
  return Eigen::Translation3d(pose.position.x, pose.position.y, pose.position.z) * rotation;
}

}  // namespace

FrameTree::FrameTree(const std::string& urdf) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf);
  if (model == nullptr)
    throw std::invalid_argument(
        "robot_description is no valid URDF; the lines above say where, and so does `check_urdf "
        "FILE`");
  for (const auto& [name, joint] : model->joints_) {
    const LinkFrame frame{joint->parent_link_name, joint->child_link_name,
                          to_isometry(joint->parent_to_joint_origin_transform)};
    const Eigen::Vector3d axis(joint->axis.x, joint->axis.y, joint->axis.z);
    const std::string label = "robot_description: joint " + prf_core::quoted(name);
    prf_core::require_within(label + " origin", frame.child_in_parent.matrix(),
                             prf_core::kMaxPosition, "m");
    switch (joint->type) {
      case urdf::Joint::FIXED:
        fixed_.push_back(frame);
        break;
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
      case urdf::Joint::PRISMATIC:
        prf_core::require_between(label + " length of the axis", axis.norm(), 1e-6, 1e6);
        joints_.insert({name, {frame, axis.normalized(), joint->type == urdf::Joint::PRISMATIC}});
        break;
      default:
        throw std::invalid_argument(label + " must be fixed, revolute, continuous or prismatic");
    }
  }
}

std::vector<std::string> FrameTree::moving_joints() const {
  std::vector<std::string> names;
  for (const auto& [name, joint] : joints_) names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<LinkFrame> FrameTree::moving(const std::vector<std::string>& names,
                                         const std::vector<double>& positions) const {
  std::vector<LinkFrame> frames;
  for (std::size_t i = 0; i < std::min(names.size(), positions.size()); ++i) {
    const auto found = joints_.find(names[i]);
    if (found == joints_.end() || !std::isfinite(positions[i])) continue;
    const MovingJoint& joint = found->second;
    frames.push_back(joint.at_zero);
    if (joint.prismatic) {
      frames.back().child_in_parent.translate(positions[i] * joint.axis);
    } else {
      frames.back().child_in_parent.rotate(Eigen::AngleAxisd(positions[i], joint.axis));
    }
  }
  return frames;
}

}  // namespace prf_ros
