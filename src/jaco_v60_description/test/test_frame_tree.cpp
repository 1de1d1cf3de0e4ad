// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <prf_ros/frame_tree.hpp>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "hand_of_urdf.hpp"

namespace jaco_v60_description {
namespace {

using prf_ros::FrameTree;
using prf_ros::LinkFrame;

std::string model() {
  std::ifstream file(URDF_FILE);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(FrameTree, AgreesWithKdl) {
  const FrameTree tree(model());
  std::mt19937 generator(3);
  std::uniform_real_distribution<> angle(-M_PI, M_PI);
  for (int i = 0; i < 200; ++i) {
    std::vector<double> q(7);
    for (double& joint : q) joint = angle(generator);
    Eigen::Isometry3d hand = Eigen::Isometry3d::Identity();
    for (const LinkFrame& frame : tree.moving(arm_joints(), q)) {
      hand = hand * frame.child_in_parent;
    }
    for (const LinkFrame& frame : tree.fixed()) {
      if (frame.child == "j2s7s300_end_effector") hand = hand * frame.child_in_parent;
    }
    EXPECT_TRUE(hand.isApprox(hand_of_urdf(q), 1e-9));
  }
}

TEST(FrameTree, HasEveryLinkOfTheModelOnce) {
  const FrameTree tree(model());
  std::set<std::string> children;
  for (const LinkFrame& frame : tree.fixed()) children.insert(frame.child);
  EXPECT_EQ(children.size(), tree.fixed().size());
  EXPECT_EQ(children.count("camera_optical_frame"), 1u);
  EXPECT_EQ(children.count("j2s7s300_link_1"), 0u);
}

TEST(FrameTree, LeavesOutWhatIsUnknownOrNotFinite) {
  const FrameTree tree(model());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(tree.moving({"nonsense", "j2s7s300_joint_1"}, {0.1, nan}).empty());
  EXPECT_EQ(tree.moving({"j2s7s300_joint_1", "j2s7s300_joint_2"}, {0.1}).size(), 1u);
}

}  // namespace
}  // namespace jaco_v60_description
