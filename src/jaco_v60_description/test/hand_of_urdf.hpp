// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace jaco_v60_description {

inline std::vector<std::string> arm_joints() {
  std::vector<std::string> names;
  for (int i = 1; i <= 7; ++i) names.push_back("j2s7s300_joint_" + std::to_string(i));
  return names;
}

// Pose of the hand in the arm's base at the seven joint angles, as KDL reads the URDF.
inline Eigen::Isometry3d hand_of_urdf(const std::vector<double>& q) {
  static const KDL::Chain chain = [] {
    KDL::Tree tree;
    KDL::Chain arm;
    if (!kdl_parser::treeFromFile(URDF_FILE, tree) ||
        !tree.getChain("j2s7s300_link_base", "j2s7s300_end_effector", arm)) {
      throw std::runtime_error("no arm in " URDF_FILE);
    }
    return arm;
  }();
  KDL::JntArray joints(7);
  joints.data = Eigen::Map<const Eigen::VectorXd>(q.data(), 7);
  KDL::Frame frame;
  if (KDL::ChainFkSolverPos_recursive(chain).JntToCart(joints, frame) < 0) {
    throw std::runtime_error("KDL gives no pose");
  }
  Eigen::Isometry3d hand = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    hand.translation()[row] = frame.p[row];
    for (int column = 0; column < 3; ++column) hand.linear()(row, column) = frame.M(row, column);
  }
  return hand;
}

}  // namespace jaco_v60_description
