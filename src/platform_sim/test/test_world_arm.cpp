// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "v60_world.hpp"

namespace platform_sim {
namespace {

TEST(World, ArmServoRespectsTheVelocityLimitsOfTheRobot) {
  World world(robot_urdf(), folded_arm());
  const ArmVector goal = folded_arm().arm_start + 0.5 * ArmVector::Ones(7);
  Eigen::VectorXd fastest = Eigen::VectorXd::Zero(19);
  for (int period = 0; period < 200; ++period) {
    world.command_arm(goal, ArmVector::Zero(7));
    for (int step = 0; step < 10; ++step) {
      world.step();
      fastest = fastest.cwiseMax(world.joints().velocities.cwiseAbs());
    }
  }
  const double degree = 3.14159265358979323846 / 180.0;
  for (int i = 12; i < 19; ++i) {
    EXPECT_LE(fastest[i], (i < 16 ? 36.0 : 48.0) * degree * 1.02) << world.joint_names()[i];
  }
  EXPECT_LT((world.joints().positions.tail<7>() - goal).norm(), 1e-3);
}

TEST(World, ReportsTheContactOfAHandPushedIntoTheBox) {
  WorldParams config = folded_arm();
  World free(robot_urdf(), config);
  const Eigen::Vector3d hand = in_platform(free, "j2s7s300_end_effector");
  config.target.tag_position_in_platform = hand + Eigen::Vector3d(0.05, 0.25, 0.07);
  World world(robot_urdf(), config);
  ArmVector goal = config.arm_start;
  goal[0] -= 1.0;
  double strongest = 0.0;
  for (int period = 0; period < 200; ++period) {
    world.command_arm(goal, ArmVector::Zero(7));
    run(world, 0.01);
    for (const Contact& contact : world.take_contacts()) {
      EXPECT_LT(contact.link_a, contact.link_b);
      const bool is_arm =
          contact.link_b.rfind("j2s7s300_", 0) == 0 || contact.link_b == "camera_link";
      if (contact.link_a != "box" || !is_arm) continue;
      strongest = std::max(strongest, contact.force);
      EXPECT_LT((world.platform().pose.inverse() * contact.position -
                 world.target().box_in_platform().translation())
                    .norm(),
                0.35);
    }
  }
  EXPECT_GT(strongest, 5.0);
  EXPECT_LT(strongest, 1000.0);
}

TEST(World, ReportsTheContactOfTheForearmWithTheBody) {
  WorldParams config = in_world("jaco_v60");
  config.arm_start << 0.0, 3.7, 0.0, 0.95, 0.0, 2.0, 0.0;
  World world(robot_urdf(), config);
  ArmVector goal = config.arm_start;
  goal[1] = 4.4;  // the hand would come to rest inside the body
  bool touched = false;
  for (int period = 0; period < 400 && !touched; ++period) {
    world.command_arm(goal, ArmVector::Zero(7));
    run(world, 0.01);
    for (const Contact& contact : world.take_contacts()) {
      touched = touched || (contact.link_a == "body" && contact.link_b.rfind("j2s7s300_", 0) == 0);
    }
  }
  EXPECT_TRUE(touched);
}

TEST(World, CompliantArmHoldsStillAndFollowsTheHand) {
  WorldParams config = folded_arm();
  config.gait = "stand_stiff";
  config.arm_mode = ArmMode::kCompliant;
  World world(robot_urdf(), config);
  const Eigen::Vector3d start = in_platform(world, "j2s7s300_end_effector");
  run(world, 2.0);
  EXPECT_LT((in_platform(world, "j2s7s300_end_effector") - start).norm(), 2e-3);
  // A damped spring toward a point 50 mm ahead, as a guiding hand pulls.
  const Eigen::Vector3d goal = start + Eigen::Vector3d(0.05, 0.0, 0.0);
  for (int step = 0; step < 3000; ++step) {
    const FrameState hand = world.frame("j2s7s300_end_effector");
    world.apply_hand_wrench(300.0 * (goal - hand.pose.translation()) - 30.0 * hand.linear,
                            Eigen::Vector3d::Zero());
    world.step();
  }
  EXPECT_LT((in_platform(world, "j2s7s300_end_effector") - goal).norm(), 0.01);
}

TEST(World, RefusesCallsOfTheOtherArmModeAndNonFiniteCommands) {
  World servo(robot_urdf(), folded_arm());
  EXPECT_THROW(servo.apply_hand_wrench(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()),
               std::invalid_argument);
  ArmVector command = ArmVector::Zero(7);
  command[2] = std::nan("");
  EXPECT_THROW(servo.command_arm(command, ArmVector::Zero(7)), std::invalid_argument);
  EXPECT_THROW(servo.command_arm(ArmVector::Zero(7), command), std::invalid_argument);
  EXPECT_THROW((void)servo.frame("tail"), std::invalid_argument);
  EXPECT_THROW(servo.push("tail", Eigen::Vector3d::Zero()), std::invalid_argument);
  EXPECT_THROW(servo.push("base_link", {std::nan(""), 0, 0}), std::invalid_argument);
  WorldParams config = folded_arm();
  config.arm_mode = ArmMode::kCompliant;
  World compliant(robot_urdf(), config);
  EXPECT_THROW(compliant.command_arm(ArmVector::Zero(7), ArmVector::Zero(7)),
               std::invalid_argument);
  EXPECT_THROW(compliant.apply_hand_wrench({std::nan(""), 0, 0}, Eigen::Vector3d::Zero()),
               std::invalid_argument);
}

// The arm behind the drivers that robots have.
using Takes = DriverModel::Takes;

constexpr double kSpeed = 0.2;  // rad/s

WorldParams with(const DriverModel& model) {
  WorldParams config = folded_arm();
  config.driver = model;
  return config;
}

DriverModel kinova() { return {Takes::kVelocities, 0.02, 0.01, 2000, 0.02, 0.0}; }

DriverPoint velocity(double speed) {
  DriverPoint point{ArmVector::Zero(7), ArmVector::Zero(7), 0.0};
  point.velocities = ArmVector::Constant(7, speed);
  return point;
}

double moved(const World& world) {
  return (world.joints().positions.tail<7>() - folded_arm().arm_start).cwiseAbs().maxCoeff();
}

TEST(WorldDriver, OfTheJacoWorksOffItsQueueOneMessageEveryTenMilliseconds) {
  World world(robot_urdf(), with(kinova()));
  for (int i = 0; i < 50; ++i) world.command_driver(velocity(kSpeed));
  run(world, 0.019);
  EXPECT_LT(moved(world), 1e-3) << "within its latency";
  run(world, 0.6);
  // 0.5 s of messages; the last one lasts 10 ms longer than its turn.
  EXPECT_NEAR(moved(world), kSpeed * 0.51, 2e-3);
  const double rest = moved(world);
  run(world, 0.2);
  EXPECT_NEAR(moved(world), rest, 1e-3) << "it stops when nothing comes";
}

TEST(WorldDriver, OfAVelocityGroupKeepsTheNewestVelocityForEver) {
  World world(robot_urdf(), with({Takes::kVelocities, 0.004, 0.0, 10, 0.0, 0.0}));
  world.command_driver(velocity(-kSpeed));
  world.command_driver(velocity(kSpeed));
  run(world, 0.504);
  EXPECT_NEAR(moved(world), kSpeed * 0.5, 2e-3);
  EXPECT_GT(world.joints().velocities[12], 0.9 * kSpeed);
}

TEST(WorldDriver, OfPositionsLagsBehindByItsServo) {
  World world(robot_urdf(), with({Takes::kPositions, 0.008, 0.0, 10, 0.0, 50.0}));
  DriverPoint point{ArmVector::Zero(7), ArmVector::Zero(7), 0.0};
  point.positions = folded_arm().arm_start + ArmVector::Constant(7, 0.01);
  world.command_driver(point);
  run(world, 0.008 + 0.02);  // one time constant
  EXPECT_NEAR(moved(world), 0.01 * (1.0 - std::exp(-1.0)), 1e-3);
  run(world, 0.3);
  EXPECT_NEAR(moved(world), 0.01, 2e-4);
}

TEST(WorldDriver, OfTrajectoriesReachesThePointInItsTime) {
  World world(robot_urdf(), with({Takes::kTrajectories, 0.008, 0.0, 10, 0.0, 100.0}));
  DriverPoint point{ArmVector::Zero(7), ArmVector::Zero(7), 0.0};
  point.positions = folded_arm().arm_start + ArmVector::Constant(7, 0.1);
  point.duration = 0.5;
  world.command_driver(point);
  run(world, 0.258);
  EXPECT_NEAR(moved(world), 0.05, 3e-3);
  run(world, 0.3);
  EXPECT_NEAR(moved(world), 0.1, 1e-3);
}

TEST(WorldDriver, HaltedComesToRestAndForgetsWhatWaits) {
  World world(robot_urdf(), with(kinova()));
  for (int i = 0; i < 100; ++i) world.command_driver(velocity(kSpeed));
  run(world, 0.3);
  world.halt_driver();
  const double there = moved(world);
  run(world, 0.5);
  EXPECT_NEAR(moved(world), there, 2e-3);
}

// Fault 1, 52: a message that is not finite, one for an arm without driver, a model without bounds
// -> refused
TEST(WorldDriver, RefusesWhatCannotBeUsed) {
  World world(robot_urdf(), with(kinova()));
  EXPECT_THROW(world.command_driver(velocity(std::nan(""))), std::invalid_argument);
  EXPECT_THROW(world.command_arm(ArmVector::Zero(7), ArmVector::Zero(7)), std::invalid_argument);
  World servo(robot_urdf(), folded_arm());
  EXPECT_THROW(servo.command_driver(velocity(0.0)), std::invalid_argument);
  EXPECT_THROW(servo.halt_driver(), std::invalid_argument);
  DriverModel wrong = kinova();
  wrong.latency = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(World(robot_urdf(), with(wrong)), std::invalid_argument);
  wrong = kinova();
  wrong.takes = Takes::kPositions;  // without a gain
  EXPECT_THROW(World(robot_urdf(), with(wrong)), std::invalid_argument);
}

}  // namespace
}  // namespace platform_sim
