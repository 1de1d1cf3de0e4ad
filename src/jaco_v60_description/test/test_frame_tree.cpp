// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "../src/frame_tree.hpp"
#include "hand_of_urdf.hpp"

namespace jaco_v60_description {
namespace {

const char kSlide[] = R"(<robot name="r"><link name="a"/><link name="b"/>
  <joint name="j" type="%TYPE%"><parent link="a"/><child link="b"/>
    <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><axis xyz="2 0 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>)";

std::string slide(const std::string& type) {
  std::string text = kSlide;
  return text.replace(text.find("%TYPE%"), 6, type);
}

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

TEST(FrameTree, SlidesPrismaticJointsAlongTheirAxis) {
  const Eigen::Isometry3d pose =
      FrameTree(slide("prismatic")).moving({"j"}, {0.25})[0].child_in_parent;
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(0.0, 0.25, 1.0), 1e-12));
}

TEST(FrameTree, LeavesOutWhatIsUnknownFixedOrNotFinite) {
  const FrameTree tree(model());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(tree.moving({"nonsense", "j2s7s300_joint_1"}, {0.1, nan}).empty());
  EXPECT_EQ(tree.moving({"j2s7s300_joint_1", "j2s7s300_joint_2"}, {0.1}).size(), 1u);
  EXPECT_TRUE(FrameTree(slide("fixed")).moving({"j"}, {0.1}).empty());
}

TEST(FrameTree, RefusesWhatIsNoRobotOrHasAnotherKindOfJoint) {
  EXPECT_THROW(FrameTree(""), std::invalid_argument);
  EXPECT_THROW(FrameTree("<robot"), std::invalid_argument);
  EXPECT_THROW(FrameTree(slide("floating")), std::invalid_argument);
}

}  // namespace
}  // namespace jaco_v60_description
