// SPDX-License-Identifier: BSD-3-Clause
// The arm behind the drivers that robots have.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "platform_sim/world.hpp"
#include "v60_world.hpp"

namespace platform_sim {
namespace {

using Takes = DriverModel::Takes;

constexpr double kSpeed = 0.2;  // rad/s

WorldParams with(const DriverModel& model) {
  WorldParams config = folded_arm();
  config.driver = model;
  return config;
}

DriverModel kinova() { return {Takes::kVelocities, 0.02, 0.01, 2000, 0.02, 0.0}; }

DriverPoint velocity(double speed) {
  DriverPoint point;
  point.velocities = ArmVector::Constant(speed);
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
  DriverPoint point;
  point.positions = folded_arm().arm_start + ArmVector::Constant(0.01);
  world.command_driver(point);
  run(world, 0.008 + 0.02);  // one time constant
  EXPECT_NEAR(moved(world), 0.01 * (1.0 - std::exp(-1.0)), 1e-3);
  run(world, 0.3);
  EXPECT_NEAR(moved(world), 0.01, 2e-4);
}

TEST(WorldDriver, OfTrajectoriesReachesThePointInItsTime) {
  World world(robot_urdf(), with({Takes::kTrajectories, 0.008, 0.0, 10, 0.0, 100.0}));
  DriverPoint point;
  point.positions = folded_arm().arm_start + ArmVector::Constant(0.1);
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
  EXPECT_THROW(world.command_arm(ArmVector::Zero(), ArmVector::Zero()), std::invalid_argument);
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
