// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "files.hpp"
#include "robot_urdf.hpp"

namespace platform_sim {
namespace {

const std::vector<std::string> kToes{"fl_toe", "fr_toe", "rl_toe", "rr_toe"};

WorldConfig folded_arm() {
  WorldConfig config;
  config.arm_start << 3.14, 2.3, 0.0, 1.5, 0.0, 3.4, 0.0;
  return config;
}

void run(World& world, double duration) {
  const auto steps = std::lround(duration / World::kTimeStep);
  for (long step = 0; step < steps; ++step) world.step();
}

Eigen::Vector3d in_platform(const World& world, const std::string& link) {
  return world.platform().pose.inverse() * world.frame(link).pose.translation();
}

TEST(World, StartsAtTimeZeroStillAndStanding) {
  WorldConfig config = folded_arm();
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
  WorldConfig config = folded_arm();
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
  WorldConfig config = folded_arm();
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
  WorldConfig config = folded_arm();
  config.scenario = "boat";
  EXPECT_THROW(config.validate(), std::invalid_argument);
  config.scenario = "cart";
  EXPECT_NO_THROW(config.validate());
  config.motion = "light";
  EXPECT_THROW(config.validate(), std::invalid_argument);
}

TEST(World, StandsThroughThreePeriodsOfHeavyMotionWithoutSlipping) {
  WorldConfig config = folded_arm();
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
  WorldConfig config = folded_arm();
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
  WorldConfig config = folded_arm();
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

TEST(World, ArmServoRespectsTheVelocityLimitsOfTheRobot) {
  World world(robot_urdf(), folded_arm());
  const ArmVector goal = folded_arm().arm_start + 0.5 * ArmVector::Ones();
  Eigen::VectorXd fastest = Eigen::VectorXd::Zero(19);
  for (int period = 0; period < 200; ++period) {
    world.command_arm(goal, ArmVector::Zero());
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

// The box stands beside the hand, and the first joint swings the hand into its wall.
TEST(World, ReportsTheContactOfAHandPushedIntoTheBox) {
  WorldConfig config = folded_arm();
  World free(robot_urdf(), config);
  const Eigen::Vector3d hand = in_platform(free, "j2s7s300_end_effector");
  config.target.tag_position_in_platform = hand + Eigen::Vector3d(0.05, 0.25, 0.07);
  World world(robot_urdf(), config);
  ArmVector goal = config.arm_start;
  goal[0] -= 1.0;
  double strongest = 0.0;
  for (int period = 0; period < 200; ++period) {
    world.command_arm(goal, ArmVector::Zero());
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
  WorldConfig config;
  config.arm_start << 0.0, 3.7, 0.0, 0.95, 0.0, 2.0, 0.0;
  World world(robot_urdf(), config);
  ArmVector goal = config.arm_start;
  goal[1] = 4.4;  // the hand would come to rest inside the body
  bool touched = false;
  for (int period = 0; period < 400 && !touched; ++period) {
    world.command_arm(goal, ArmVector::Zero());
    run(world, 0.01);
    for (const Contact& contact : world.take_contacts()) {
      touched = touched || (contact.link_a == "body" && contact.link_b.rfind("j2s7s300_", 0) == 0);
    }
  }
  EXPECT_TRUE(touched);
}

// Eight times gravity sideways: no foot would hold.
TEST(World, CarriesTheBaseThroughTheMotionThatIsPrinted) {
  WorldConfig config = folded_arm();
  config.motion = "as_printed";
  World world(robot_urdf(), config);
  const Eigen::Isometry3d start = world.platform().pose.inverse() * world.base().pose;
  double fastest = 0.0;
  for (int period = 0; period < 400; ++period) {
    run(world, 0.01);
    const Eigen::Isometry3d base = world.platform().pose.inverse() * world.base().pose;
    ASSERT_LT((base.translation() - start.translation()).norm(), 1e-5) << world.time();
    ASSERT_LT(Eigen::AngleAxisd(base.linear() * start.linear().transpose()).angle(), 1e-5);
    fastest = std::max(fastest, world.base().linear.norm());
  }
  EXPECT_FALSE(world.fallen());
  EXPECT_NEAR(fastest, 6.28, 0.1);
}

TEST(World, CarriesTheBaseAlongARecordedMotionAndTheArmFeelsIt) {
  std::string text = "time,x,y,z,roll,pitch,yaw\n";
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.01 * i, y = 0.1 * std::sin(3.0 * t);
    text += std::to_string(t) + ",-0.1," + std::to_string(y) + ",0.52,0,0,0.1\n";
  }
  const TemporaryFile file(text, ".csv");
  WorldConfig config = folded_arm();
  config.motion = "light";
  config.body_motion = file.path();
  World world(robot_urdf(), config);
  const double still = world.joints().efforts[12];
  double farthest = 0.0, effort = 0.0;
  for (int period = 0; period < 500; ++period) {
    run(world, 0.01);
    const Eigen::Isometry3d base = world.platform().pose.inverse() * world.base().pose;
    // As RecordedMotion plays: the first second rises, 4 s last until the end's turn begins.
    if (world.time() > 1.0 && world.time() < 4.0) {
      const Eigen::Vector3d expected(-0.1, 0.1 * std::sin(3.0 * (world.time() - 0.5)), 0.52);
      ASSERT_LT((base.translation() - expected).norm(), 1e-5) << world.time();
    }
    farthest = std::max(farthest, std::abs(base.translation().y()));
    effort = std::max(effort, std::abs(world.joints().efforts[12] - still));
    for (const Contact& contact : world.take_contacts()) {
      EXPECT_NE(contact.link_b, "platform") << contact.link_a;
      EXPECT_NE(contact.link_a, "platform") << contact.link_b;
    }
  }
  EXPECT_NEAR(farthest, 0.1, 0.003);
  EXPECT_GT(effort, 0.1);
}

TEST(World, CompliantArmHoldsStillAndFollowsTheHand) {
  WorldConfig config = folded_arm();
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

TEST(World, NoticesWhenTheRobotIsPulledOver) {
  WorldConfig config = folded_arm();
  config.arm_mode = ArmMode::kCompliant;
  World world(robot_urdf(), config);
  world.apply_hand_wrench(Eigen::Vector3d(0.0, 600.0, 0.0), Eigen::Vector3d::Zero());
  run(world, 3.0);
  EXPECT_TRUE(world.fallen());
}

TEST(World, TwoWorldsAreBitwiseEqual) {
  WorldConfig config = folded_arm();
  config.motion = "heavy";
  config.gait = "step";
  config.seed = 11;
  const auto outcome = [&] {
    World world(robot_urdf(), config);
    ArmVector goal = config.arm_start;
    for (int period = 0; period < 150; ++period) {
      goal[0] += 0.003;
      world.command_arm(goal, ArmVector::Constant(0.3));
      run(world, 0.01);
    }
    const JointStates joints = world.joints();
    Eigen::VectorXd state(19 * 3 + 16);
    state << joints.positions, joints.velocities, joints.efforts,
        Eigen::Map<const Eigen::VectorXd>(world.base().pose.data(), 16);
    return state;
  };
  const Eigen::VectorXd first = outcome();
  const Eigen::VectorXd second = outcome();
  for (int i = 0; i < first.size(); ++i) EXPECT_EQ(first[i], second[i]) << i;
}

TEST(World, SeedChangesTheMotionOfThePlatform) {
  WorldConfig config = folded_arm();
  config.motion = "light";
  config.seed = 1;
  World first(robot_urdf(), config);
  config.seed = 2;
  World second(robot_urdf(), config);
  run(first, 0.5);
  run(second, 0.5);
  EXPECT_FALSE(first.platform().pose.isApprox(second.platform().pose, 1e-6));
}

TEST(World, RefusesBadConfigurations) {
  const double nan = std::nan("");
  const std::vector<std::function<void(WorldConfig&)>> faults{
      [](WorldConfig& config) { config.motion = "stormy"; },
      [](WorldConfig& config) { config.gait = "gallop"; },
      [](WorldConfig& config) { config.friction = 0.0; },
      [&](WorldConfig& config) { config.friction = nan; },
      [](WorldConfig& config) { config.base_start_x = 3.0; },
      [](WorldConfig& config) { config.base_start_y = 1.0; },
      [&](WorldConfig& config) { config.base_start_yaw = nan; },
      [](WorldConfig& config) { config.body_motion = "absent.csv"; },
      [](WorldConfig& config) {
        config.motion = "as_printed";
        config.gait = "step";
      },
      [](WorldConfig& config) { config.servo_gain = -1.0; },
      [&](WorldConfig& config) { config.arm_start[3] = nan; },
      [](WorldConfig& config) { config.arm_start[1] = 0.1; },
      [](WorldConfig& config) { config.target.tag_size = 0.0; },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    WorldConfig config = folded_arm();
    faults[i](config);
    EXPECT_THROW(World(robot_urdf(), config), std::invalid_argument) << "fault " << i;
  }
}

TEST(World, RefusesRobotsThatAreNotTheOneItKnows) {
  EXPECT_THROW(World("<robot", folded_arm()), std::invalid_argument);
  EXPECT_THROW(World("<robot name='r'><link name='base_link'/></robot>", folded_arm()),
               std::invalid_argument);
  std::string legless = robot_urdf();
  for (std::size_t at; (at = legless.find("fl_knee")) != std::string::npos;) {
    legless.replace(at, 7, "fl_knie");
  }
  EXPECT_THROW(World(legless, folded_arm()), std::invalid_argument);
}

TEST(World, RefusesCallsOfTheOtherArmModeAndNonFiniteCommands) {
  World servo(robot_urdf(), folded_arm());
  EXPECT_THROW(servo.apply_hand_wrench(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()),
               std::invalid_argument);
  ArmVector command = ArmVector::Zero();
  command[2] = std::nan("");
  EXPECT_THROW(servo.command_arm(command, ArmVector::Zero()), std::invalid_argument);
  EXPECT_THROW(servo.command_arm(ArmVector::Zero(), command), std::invalid_argument);
  EXPECT_THROW((void)servo.frame("tail"), std::invalid_argument);
  EXPECT_THROW(servo.push("tail", Eigen::Vector3d::Zero()), std::invalid_argument);
  EXPECT_THROW(servo.push("base_link", {std::nan(""), 0, 0}), std::invalid_argument);
  WorldConfig config = folded_arm();
  config.arm_mode = ArmMode::kCompliant;
  World compliant(robot_urdf(), config);
  EXPECT_THROW(compliant.command_arm(ArmVector::Zero(), ArmVector::Zero()), std::invalid_argument);
  EXPECT_THROW(compliant.apply_hand_wrench({std::nan(""), 0, 0}, Eigen::Vector3d::Zero()),
               std::invalid_argument);
}

}  // namespace
}  // namespace platform_sim
