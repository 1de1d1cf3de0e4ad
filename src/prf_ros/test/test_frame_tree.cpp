// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/frame_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace prf_ros {
namespace {

const char kSlide[] = R"(<robot name="r"><link name="a"/><link name="b"/>
  <joint name="j" type="%TYPE%"><parent link="a"/><child link="b"/>
    <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><axis xyz="2 0 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>)";

std::string slide(const std::string& type) {
  std::string text = kSlide;
  return text.replace(text.find("%TYPE%"), 6, type);
}

TEST(FrameTree, TurnsRevoluteJointsAboutTheirAxis) {
  const LinkFrame frame = FrameTree(slide("revolute")).moving({"j"}, {M_PI / 2})[0];
  EXPECT_EQ(frame.parent, "a");
  EXPECT_EQ(frame.child, "b");
  EXPECT_TRUE(frame.child_in_parent.translation().isApprox(Eigen::Vector3d(0.0, 0.0, 1.0), 1e-12));
  const Eigen::Vector3d y_of_child = frame.child_in_parent.linear() * Eigen::Vector3d::UnitY();
  EXPECT_TRUE(y_of_child.isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
}

TEST(FrameTree, SlidesPrismaticJointsAlongTheirAxis) {
  const Eigen::Isometry3d pose =
      FrameTree(slide("prismatic")).moving({"j"}, {0.25})[0].child_in_parent;
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(0.0, 0.25, 1.0), 1e-12));
}

TEST(FrameTree, HasFixedJointsOnceAndNeverMovesThem) {
  const FrameTree tree(slide("fixed"));
  ASSERT_EQ(tree.fixed().size(), 1u);
  EXPECT_EQ(tree.fixed()[0].child, "b");
  EXPECT_TRUE(tree.moving({"j"}, {0.1}).empty());
}

TEST(FrameTree, LeavesOutWhatIsUnknownNotFiniteOrWithoutPosition) {
  const FrameTree tree(slide("continuous"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(tree.moving({"k", "j"}, {0.1, nan}).empty());
  EXPECT_EQ(tree.moving({"j", "j"}, {0.1}).size(), 1u);
}

TEST(FrameTree, KnowsItsMovingJoints) {
  EXPECT_EQ(FrameTree(slide("prismatic")).moving_joints(), std::vector<std::string>{"j"});
  EXPECT_TRUE(FrameTree(slide("revolute")).is_moving_joint("j"));
  EXPECT_FALSE(FrameTree(slide("fixed")).is_moving_joint("j"));
}

// Fault 43: absurd numbers in robot_description -> refused at the start, with the joint's name
TEST(FrameTree, RefusesNumbersBeyondPhysicalBounds) {
  for (const auto& [good, bad] : std::vector<std::pair<std::string, std::string>>{
           {"xyz=\"0 0 1\"", "xyz=\"0 0 1e300\""}, {"xyz=\"2 0 0\"", "xyz=\"0 0 0\""}}) {
    std::string text = slide("revolute");
    text.replace(text.find(good), good.size(), bad);
    EXPECT_THROW(FrameTree{text}, std::invalid_argument) << bad;
  }
}

TEST(FrameTree, RefusesWhatIsNoRobotOrHasAnotherKindOfJoint) {
  EXPECT_THROW(FrameTree(""), std::invalid_argument);
  EXPECT_THROW(FrameTree("<robot"), std::invalid_argument);
  EXPECT_THROW(FrameTree(slide("floating")), std::invalid_argument);
}

}  // namespace
}  // namespace prf_ros
