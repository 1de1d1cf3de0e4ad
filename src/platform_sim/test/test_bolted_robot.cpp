// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "v60_world.hpp"

namespace platform_sim {
namespace {

WorldParams bolted() {
  WorldParams config = in_world("ur5e_deck");
  config.scenario = "quay";
  config.motion = "heavy";
  return config;
}

TEST(BoltedRobot, GoesWithTheDeckAndStandsAsItStarted) {
  const WorldParams config = bolted();
  World world(robot_urdf("ur5e_deck"), config);
  EXPECT_EQ(world.joint_names(), config.robot.arm_joints);
  const Eigen::Isometry3d start = world.platform().pose.inverse() * world.base().pose;
  EXPECT_NEAR(start.translation().x(), config.base_start_x, 1e-3);
  EXPECT_NEAR(start.translation().z(), 0.0, 1e-3);
  double moved = 0.0;
  for (int i = 0; i < 30; ++i) {
    run(world, 0.1);
    const Eigen::Isometry3d now = world.platform().pose.inverse() * world.base().pose;
    EXPECT_LT((now.translation() - start.translation()).norm(), 1e-3);
    moved = std::max(moved, (world.base().pose.translation() - start.translation()).norm());
    EXPECT_LT((world.joints().positions - config.arm_start).cwiseAbs().maxCoeff(), 0.02);
  }
  EXPECT_GT(moved, 0.02);
  EXPECT_EQ(world.carrier().pose.translation().norm(), 0.0) << "the box stands ashore";
  EXPECT_FALSE(world.fallen());
}

TEST(BoltedRobot, MovesItsJointsWhereTheyAreCommanded) {
  WorldParams config = bolted();
  config.motion = "none";
  World world(robot_urdf("ur5e_deck"), config);
  const ArmVector goal = config.arm_start + ArmVector::Constant(6, 0.2);
  for (int tick = 0; tick < 100; ++tick) {
    world.command_arm(goal, ArmVector::Zero(6));
    run(world, 0.01);
  }
  EXPECT_LT((world.joints().positions - goal).cwiseAbs().maxCoeff(), 0.01);
}

// Fault 45: what a robot without legs cannot do, or joints of another robot -> refused
TEST(BoltedRobot, RefusesWhatNeedsLegs) {
  WorldParams config = bolted();
  config.gait = "step";
  EXPECT_THROW(World(robot_urdf("ur5e_deck"), config), std::invalid_argument);
  config = bolted();
  config.disturb = "stumble:1@1";
  EXPECT_THROW(World(robot_urdf("ur5e_deck"), config), std::invalid_argument);
  EXPECT_THROW(World(robot_urdf("panda_deck"), bolted()), std::invalid_argument);
  config = bolted();
  config.arm_start = ArmVector::Zero(7);
  EXPECT_THROW(World(robot_urdf("ur5e_deck"), config), std::invalid_argument);
}

}  // namespace
}  // namespace platform_sim
