// SPDX-License-Identifier: BSD-3-Clause
#include "physics/bullet_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/multibody_from_urdf.hpp"
#include "small_robots.hpp"

namespace platform_sim {
namespace {

constexpr double kTimeStep = 0.001;
constexpr double kGravity = 9.81;
constexpr double kFriction = 0.5;

Eigen::Isometry3d at(const Eigen::Vector3d& position) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  return pose;
}

const std::string kBlockUrdf =
    "<robot name='b'><link name='block'>" +
    inertial(10.0, "0 0 0", "ixx='0.083' ixy='0' ixz='0' iyy='0.083' iyz='0' izz='0.15'") +
    "<collision><geometry><box size='0.3 0.3 0.1'/></geometry></collision></link></robot>";

// A block of 10 kg, built as a robot without joints, on a deck that accelerates along `direction`.
struct BlockOnDeck {
  BulletScene scene{kTimeStep};
  CuboidBody deck{scene,
                  "deck",
                  {{Eigen::Isometry3d::Identity(), {6.0, 6.0, 0.1}}},
                  {1, 2},
                  at({0.0, 0.0, -0.05})};
  RobotModel block{scene, kBlockUrdf, RobotModel::Base::kFloating, [](const std::string&) {
                     return RobotSurface{"", {2, 1}, kFriction, 1e5, 3e3};
                   }};

  BlockOnDeck() {
    block.set_base_pose(at({0.0, 0.0, 0.05}));
    block.update_poses();
    for (int step = 0; step < 300; ++step) scene.step();
  }

  // Distance that the block stays behind the deck in 1 s.
  double slip(double acceleration, const Eigen::Vector3d& direction) {
    const Eigen::Vector3d start = block.frame("block").pose.translation();
    double travel = 0.0;
    for (int step = 1; step <= 1000; ++step) {
      const double time = step * kTimeStep;
      travel = 0.5 * acceleration * time * time;
      deck.move_to(at(travel * direction + Eigen::Vector3d(0.0, 0.0, -0.05)));
      scene.step();
    }
    return travel - (block.frame("block").pose.translation() - start).dot(direction);
  }
};

TEST(BulletScene, DeckCarriesABlockUpToTheFrictionLimitInAnyDirection) {
  for (double angle : {0.0, 0.4, 0.785, 1.571, 2.5}) {
    BlockOnDeck world;
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
    EXPECT_LT(std::abs(world.slip(0.95 * kFriction * kGravity, direction)), 1e-3) << angle;
  }
}

TEST(BulletScene, BlockSlipsAsCoulombSaysAboveTheFrictionLimit) {
  for (double angle : {0.0, 0.4, 0.785, 1.571, 2.5}) {
    BlockOnDeck world;
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
    const double limit = kFriction * kGravity;
    const double expected = 0.5 * 0.2 * limit;  // s = (a - mu g) t^2 / 2 at 1 s
    EXPECT_NEAR(world.slip(1.2 * limit, direction), expected, 0.02 * expected) << angle;
  }
}

TEST(BulletScene, ContactForcesOfAStandingBlockSumToItsWeight) {
  BlockOnDeck world;
  double force = 0.0;
  for (const ContactPoint& point : world.scene.contact_points()) {
    EXPECT_TRUE((point.link_a == "deck" && point.link_b == "block") ||
                (point.link_a == "block" && point.link_b == "deck"));
    EXPECT_NEAR(point.position.z(), 0.0, 2e-3);
    force += point.force;
  }
  EXPECT_NEAR(force, 10.0 * kGravity, 0.01 * 10.0 * kGravity);
}

}  // namespace
}  // namespace platform_sim
