// SPDX-License-Identifier: BSD-3-Clause
#include "camera_sim/target_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace camera_sim {
namespace {

bool contains(const Cuboid& cuboid, const Eigen::Vector3d& point) {
  const Eigen::Vector3d local = cuboid.pose_in_platform.inverse() * point;
  return (local.cwiseAbs().array() <= 0.5 * cuboid.size.array() + 1e-12).all();
}

bool is_solid(const TargetBox& box, const Eigen::Vector3d& point) {
  for (const Cuboid& wall : box.walls()) {
    if (contains(wall, point)) return true;
  }
  return contains(box.post(), point);
}

TEST(TargetBox, TagFacesTheOpeningOnTheInnerFaceOfTheBackWall) {
  const TargetBox box;
  const Eigen::Isometry3d tag = box.tag_in_platform();
  EXPECT_NEAR(tag.linear().determinant(), 1.0, 1e-15);
  EXPECT_TRUE(tag.linear().col(2).isApprox(-Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(tag.linear().col(1).isApprox(Eigen::Vector3d::UnitZ()));
  for (double x : {-0.05, 0.0, 0.05}) {
    for (double y : {-0.05, 0.0, 0.05}) {
      EXPECT_FALSE(is_solid(box, tag * Eigen::Vector3d(x, y, 0.001)));
      EXPECT_TRUE(is_solid(box, tag * Eigen::Vector3d(x, y, -0.001)));
    }
  }
}

TEST(TargetBox, IsHollowToItsInnerSizeAndOpenTowardTheRobot) {
  const TargetBox box;
  const Eigen::Isometry3d centre = box.box_in_platform();
  for (double x = -0.3; x < 0.0999; x += 0.01) {
    for (double y : {-0.149, 0.0, 0.149}) {
      for (double z : {-0.149, 0.0, 0.149}) {
        EXPECT_FALSE(is_solid(box, centre * Eigen::Vector3d(x, y, z)));
      }
    }
  }
  for (const Eigen::Vector3d& out :
       {Eigen::Vector3d(0.101, 0, 0), Eigen::Vector3d(0, 0.151, 0), Eigen::Vector3d(0, -0.151, 0),
        Eigen::Vector3d(0, 0, 0.151), Eigen::Vector3d(0, 0, -0.151)}) {
    EXPECT_TRUE(is_solid(box, centre * out));
  }
  EXPECT_NEAR((centre.inverse() * box.tag_in_platform().translation()).z(), 0.07, 1e-15);
}

TEST(TargetBox, PostCarriesItFromTheDeck) {
  const TargetBox box;
  const double x = box.post().pose_in_platform.translation().x();
  for (double z = 0.0; z < 1.08; z += 0.005) EXPECT_TRUE(is_solid(box, {x, 0.0, z}));
}

TEST(TargetBox, IsPlacedByItsTag) {
  TargetBox there;
  there.tag_position_in_platform = Eigen::Vector3d(0.8, 0.1, 1.2);
  there.yaw = -0.3;
  TargetBox box;
  box.place_tag(there.tag_in_platform());
  EXPECT_TRUE(box.tag_in_platform().isApprox(there.tag_in_platform(), 1e-12));
}

TEST(TargetBox, StandsOnTheChassisOfACart) {
  TargetBox box;
  box.on_cart = true;
  ASSERT_EQ(box.support().size(), 2u);
  const Eigen::Isometry3d& post = box.post().pose_in_platform;
  const double foot = post.translation().z() - 0.5 * box.post().size.z();
  EXPECT_TRUE(contains(
      cart_chassis(),
      post.translation() - Eigen::Vector3d(0.0, 0.0, post.translation().z() - foot + 1e-9)));
  EXPECT_GT(cart_chassis().pose_in_platform.translation().z() - 0.5 * cart_chassis().size.z(), 0.0);
}

// Fault 43, 52: sizes and places NaN, 1e308 or 5e-324 -> refused
TEST(TargetBox, ThePostInTheWayStandsOnTheDeckAtTheRightBeforeTheBox) {
  TargetBox box;
  box.obstructed = true;
  box.yaw = 0.3;
  const Cuboid post = box.obstacle();
  const Eigen::Vector3d in_tag =
      box.tag_in_platform().inverse() * post.pose_in_platform.translation();
  EXPECT_NEAR(in_tag.x(), 0.20, 1e-12);
  EXPECT_NEAR(in_tag.z(), 0.26, 1e-12);
  EXPECT_NEAR(post.pose_in_platform.translation().z(), 0.5 * post.size.z(), 1e-12);
  EXPECT_GT(in_tag.z() - 0.5 * post.size.x(), box.inner_depth);
}

TEST(TargetBox, RefusesImpossibleSizes) {
  const std::vector<std::function<void(TargetBox&)>> faults{
      [](TargetBox& box) { box.tag_size = 0.0; },
      [](TargetBox& box) { box.tag_size = 0.2; },
      [](TargetBox& box) { box.inner_width = -0.3; },
      [](TargetBox& box) { box.inner_depth = std::nan(""); },
      [](TargetBox& box) { box.wall_thickness = std::numeric_limits<double>::infinity(); },
      [](TargetBox& box) { box.post_width = 0.0; },
      [](TargetBox& box) { box.tag_above_box_centre = 0.11; },
      [](TargetBox& box) { box.tag_position_in_platform.z() = 0.1; },
      [](TargetBox& box) { box.tag_position_in_platform.x() = std::nan(""); },
      [](TargetBox& box) { box.tag_position_in_platform.y() = 1e308; },
      [](TargetBox& box) { box.yaw = 1e308; },
      [](TargetBox& box) { box.tag_size = 5e-324; },
      [](TargetBox& box) { box.tag_above_box_centre = std::nan(""); },
      [](TargetBox& box) { box.inner_depth = 1e308; },
      [](TargetBox& box) { box.wall_thickness = 5e-324; },
  };
  EXPECT_NO_THROW(TargetBox().validate());
  for (std::size_t i = 0; i < faults.size(); ++i) {
    TargetBox box;
    faults[i](box);
    EXPECT_THROW(box.validate(), std::invalid_argument) << "fault " << i;
  }
}

TEST(TargetBox, TurnsAsOneAboutTheVerticalThroughTheTag) {
  const TargetBox straight;
  TargetBox turned;
  turned.yaw = 0.3;
  const Eigen::Isometry3d tag = straight.tag_in_platform();
  const Eigen::Vector3d pivot = tag.translation();
  const Eigen::Isometry3d turn = Eigen::Translation3d(pivot) *
                                 Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                 Eigen::Translation3d(-pivot);
  EXPECT_TRUE(turned.tag_in_platform().isApprox(turn * tag));
  EXPECT_TRUE(turned.post().pose_in_platform.isApprox(turn * straight.post().pose_in_platform));
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(
        turned.walls()[i].pose_in_platform.isApprox(turn * straight.walls()[i].pose_in_platform));
  }
}

}  // namespace
}  // namespace camera_sim
