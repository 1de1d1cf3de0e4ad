// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "v60_world.hpp"

namespace platform_sim {
namespace {

const std::vector<std::string> kToes{"fl_toe", "fr_toe", "rl_toe", "rr_toe"};

TEST(World, StartsAtTimeZeroStillAndStanding) {
  WorldParams config = folded_arm();
  config.gait = "stand_stiff";
  World world(robot_urdf(), config);
  EXPECT_EQ(world.time(), 0.0);
  EXPECT_EQ(world.joint_names().size(), 19u);
  EXPECT_TRUE(world.platform().pose.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_LT(world.joints().velocities.norm(), 5e-3);
  EXPECT_LT(world.base().linear.norm(), 1e-3);
  const Eigen::Vector3d base = world.base().pose.translation();
  EXPECT_LT((base - Eigen::Vector3d(-0.156, 0.0, 0.526)).norm(), 3e-3);
  EXPECT_FALSE(world.fallen());
  EXPECT_TRUE(world.take_contacts().empty());
}

TEST(World, FeetCarryTheWeightOfTheRobot) {
  World world(robot_urdf(), folded_arm());
  run(world, 0.5);
  (void)world.take_contacts();
  world.step();
  double force = 0.0;
  for (const Contact& contact : world.take_contacts()) {
    EXPECT_TRUE(contact.link_a == "platform" || contact.link_b == "platform");
    force += contact.force;
  }
  const double weight = 57.5 * 9.81;
  EXPECT_NEAR(force, weight, 0.01 * weight);
}

TEST(World, TagIsFixedToThePlatform) {
  WorldParams config = folded_arm();
  config.motion = "heavy";
  World world(robot_urdf(), config);
  run(world, 1.0);
  const Eigen::Isometry3d expected = world.platform().pose * world.target().tag_in_platform();
  EXPECT_TRUE(world.tag().pose.isApprox(expected, 1e-12));
  const Eigen::Vector3d before = world.tag().pose.translation();
  const Eigen::Vector3d velocity = world.tag().linear;
  world.step();
  const Eigen::Vector3d moved = (world.tag().pose.translation() - before) / World::kTimeStep;
  EXPECT_LT((moved - velocity).norm(), 1e-3);
}

TEST(World, HandPushesTheCartAsideAndTheRobotStays) {
  WorldParams config = folded_arm();
  config.scenario = "cart";
  config.gait = "stand_stiff";
  config.seed = 4;
  World world(robot_urdf(), config);
  const Eigen::Vector3d base = world.base().pose.translation();
  const Eigen::Vector3d tag = world.tag().pose.translation();
  run(world, 2.0);
  EXPECT_LT((world.tag().pose.translation() - tag).norm(), 1e-12);
  run(world, 6.0);
  const Eigen::Vector3d pushed = world.tag().pose.translation() - tag;
  EXPECT_TRUE(pushed.norm() >= 0.10 && pushed.norm() <= 0.15) << pushed.norm();
  EXPECT_EQ(pushed.z(), 0.0);
  EXPECT_LT((world.base().pose.translation() - base).norm(), 2e-3);
  EXPECT_TRUE(world.platform().pose.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(World, RefusesUnknownScenariosAndACartOnAMovingFloor) {
  WorldParams config = folded_arm();
  config.scenario = "boat";
  EXPECT_THROW(config.validate(), std::invalid_argument);
  config.scenario = "cart";
  EXPECT_NO_THROW(config.validate());
  config.motion = "light";
  EXPECT_THROW(config.validate(), std::invalid_argument);
}

TEST(World, RefusesAnUnknownObstacleAndAPostBeforeACart) {
  WorldParams config = folded_arm();
  config.obstacle = "wall";
  EXPECT_THROW(config.validate(), std::invalid_argument);
  config.obstacle = "post";
  EXPECT_NO_THROW(config.validate());
  config.scenario = "cart";
  EXPECT_THROW(config.validate(), std::invalid_argument);
}

TEST(World, StandsThroughThreePeriodsOfHeavyMotionWithoutSlipping) {
  WorldParams config = folded_arm();
  config.motion = "heavy";
  World world(robot_urdf(), config);
  std::vector<Eigen::Vector3d> toes;
  for (const std::string& toe : kToes) toes.push_back(in_platform(world, toe));
  for (int second = 0; second < 8; ++second) {
    run(world, 1.0);
    for (std::size_t i = 0; i < kToes.size(); ++i) {
      EXPECT_LT((in_platform(world, kToes[i]) - toes[i]).norm(), 0.010) << kToes[i];
    }
  }
  EXPECT_FALSE(world.fallen());
  EXPECT_GT(world.platform().pose.translation().norm(), 1e-3);
}

TEST(World, StepsInPlaceThroughHeavyMotion) {
  WorldParams config = folded_arm();
  config.motion = "heavy";
  config.gait = "step";
  World world(robot_urdf(), config);
  const Eigen::Vector3d start = in_platform(world, "base_link");
  std::vector<double> lift(kToes.size(), 0.0);
  double farthest = 0.0;
  for (int period = 0; period < 1000; ++period) {
    run(world, 0.01);
    farthest = std::max(farthest, (in_platform(world, "base_link") - start).norm());
    for (std::size_t i = 0; i < kToes.size(); ++i) {
      lift[i] = std::max(lift[i], in_platform(world, kToes[i]).z());
    }
  }
  EXPECT_FALSE(world.fallen());
  EXPECT_LT(farthest, 0.2);
  for (double height : lift) EXPECT_GT(height, 0.05);
}

TEST(World, SlipsWhenTheDeckIsTooSmooth) {
  WorldParams config = folded_arm();
  config.motion = "heavy";
  config.friction = 0.05;
  World world(robot_urdf(), config);
  const Eigen::Vector3d toe = in_platform(world, "fl_toe");
  double slip = 0.0;
  for (int i = 0; i < 50; ++i) {
    run(world, 0.1);
    slip = std::max(slip, (in_platform(world, "fl_toe") - toe).norm());
  }
  EXPECT_GT(slip, 0.010);
}

// The criterion is that of the judge: 0.35 m, 30 degrees, or body and platform in contact.
// Fault 36: robot falls (low, tilted or lying) -> the run ends a second later, with time and cause
// in the log
TEST(World, HasFallenFromTheFirstStepBeyondTheCriterion) {
  WorldParams config = folded_arm();
  config.arm_mode = ArmMode::kCompliant;
  World world(robot_urdf(), config);
  world.apply_hand_wrench(Eigen::Vector3d(0.0, 600.0, 0.0), Eigen::Vector3d::Zero());
  const auto is_beyond = [&] {
    const Eigen::Isometry3d base = world.platform().pose.inverse() * world.base().pose;
    const double tilt = std::acos(base.linear()(2, 2));
    bool touches = false;
    for (const Contact& contact : world.take_contacts()) {
      touches = touches || (contact.link_a == "body" && contact.link_b == "platform");
    }
    return base.translation().z() < 0.35 || tilt > 30.0 * M_PI / 180.0 || touches;
  };
  while (world.time() < 3.0 && !world.fallen()) {
    world.step();
    ASSERT_EQ(world.fallen(), is_beyond()) << world.time();
  }
  EXPECT_TRUE(world.fallen());
}

TEST(World, TwoWorldsAreBitwiseEqual) {
  WorldParams config = folded_arm();
  config.motion = "heavy";
  config.gait = "step";
  config.seed = 11;
  const auto state_after = [&] {
    World world(robot_urdf(), config);
    ArmVector goal = config.arm_start;
    for (int period = 0; period < 150; ++period) {
      goal[0] += 0.003;
      world.command_arm(goal, ArmVector::Constant(7, 0.3));
      run(world, 0.01);
    }
    const JointStates joints = world.joints();
    Eigen::VectorXd state(19 * 3 + 16);
    state << joints.positions, joints.velocities, joints.efforts,
        Eigen::Map<const Eigen::VectorXd>(world.base().pose.data(), 16);
    return state;
  };
  const Eigen::VectorXd first = state_after();
  const Eigen::VectorXd second = state_after();
  for (int i = 0; i < first.size(); ++i) EXPECT_EQ(first[i], second[i]) << i;
}

TEST(World, SeedChangesTheMotionOfThePlatform) {
  WorldParams config = folded_arm();
  config.motion = "light";
  config.seed = 1;
  World first(robot_urdf(), config);
  config.seed = 2;
  World second(robot_urdf(), config);
  run(first, 0.5);
  run(second, 0.5);
  EXPECT_FALSE(first.platform().pose.isApprox(second.platform().pose, 1e-6));
}

// Fault 28, 52: world parameters NaN or beyond physical bounds -> refused
TEST(World, RefusesBadConfigurations) {
  const double nan = std::nan("");
  const std::vector<std::function<void(WorldParams&)>> faults{
      [](WorldParams& config) { config.motion = "stormy"; },
      [](WorldParams& config) { config.gait = "gallop"; },
      [](WorldParams& config) { config.friction = 0.0; },
      [&](WorldParams& config) { config.friction = nan; },
      [](WorldParams& config) { config.base_start_x = 3.0; },
      [](WorldParams& config) { config.base_start_y = 1.0; },
      [&](WorldParams& config) { config.base_start_yaw = nan; },
      [](WorldParams& config) { config.body_motion = "absent.csv"; },
      [](WorldParams& config) {
        config.motion = "as_printed";
        config.gait = "step";
      },
      [](WorldParams& config) { config.servo_gain = -1.0; },
      [&](WorldParams& config) { config.arm_start[3] = nan; },
      [](WorldParams& config) { config.arm_start[1] = 0.1; },
      [](WorldParams& config) { config.target.tag_size = 0.0; },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    WorldParams config = folded_arm();
    faults[i](config);
    EXPECT_THROW(World(robot_urdf(), config), std::invalid_argument) << "fault " << i;
  }
}

TEST(World, RefusesRobotsThatAreNotTheOneItKnows) {
  EXPECT_THROW(World("<robot", folded_arm()), std::invalid_argument);
  EXPECT_THROW(World("<robot name='r'><link name='base_link'/></robot>", folded_arm()),
               std::invalid_argument);
  std::string three_legged = robot_urdf();
  for (std::size_t at; (at = three_legged.find("fl_knee")) != std::string::npos;) {
    three_legged.replace(at, 7, "fl_knie");
  }
  EXPECT_THROW(World(three_legged, folded_arm()), std::invalid_argument);
}

}  // namespace
}  // namespace platform_sim
