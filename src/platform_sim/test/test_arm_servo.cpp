// SPDX-License-Identifier: BSD-3-Clause
#include "physics/arm_servo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "small_robots.hpp"

namespace platform_sim {
namespace {

constexpr double kTimeStep = 0.001;
const std::vector<std::string> kJoints{"shoulder", "elbow"};

struct Arm {
  BulletScene scene{kTimeStep};
  RobotModel robot{scene, two_link_robot(), RobotModel::Base::kFixed, untouchable};
  double time = 0.0;

  [[nodiscard]] Eigen::Vector2d positions() const {
    return {robot.position(robot.joint("shoulder")), robot.position(robot.joint("elbow"))};
  }
  [[nodiscard]] Eigen::Vector2d velocities() const {
    return {robot.velocity(robot.joint("shoulder")), robot.velocity(robot.joint("elbow"))};
  }
  void step(ArmDrive& drive) {
    drive.update(time);
    scene.step();
    time += kTimeStep;
  }
};

TEST(ArmServo, ReachesAStepWithoutExceedingVelocityOrTorque) {
  Arm arm;
  ArmServo servo(arm.scene, arm.robot, kJoints, 20.0, 0.0);
  const Eigen::Vector2d goal(1.5, -1.0);
  servo.command(goal, Eigen::Vector2d::Zero(), arm.time);
  Eigen::Vector2d fastest = Eigen::Vector2d::Zero();
  for (int step = 0; step < 3000; ++step) {
    arm.step(servo);
    fastest = fastest.cwiseMax(arm.velocities().cwiseAbs());
    EXPECT_LE(std::abs(servo.efforts()[0]), 60.0 + 1e-9);
    EXPECT_LE(std::abs(servo.efforts()[1]), 30.0 + 1e-9);
  }
  EXPECT_LT((arm.positions() - goal).norm(), 1e-6);
  EXPECT_NEAR(fastest[0], 2.0, 0.005 * 2.0);
  EXPECT_NEAR(fastest[1], 1.0, 0.005 * 1.0);
}

TEST(ArmServo, HoldsAgainstGravityWithTheTorqueThatGravityAsksFor) {
  Arm arm;
  ArmServo servo(arm.scene, arm.robot, kJoints, 20.0, 0.0);
  servo.command(Eigen::Vector2d(1.0, 0.5), Eigen::Vector2d::Zero(), arm.time);
  for (int step = 0; step < 3000; ++step) arm.step(servo);
  EXPECT_LT((servo.efforts() + arm.robot.gravity_torques()).norm(), 1e-6);
}

TEST(ArmServo, FollowsAMovingCommandWithinOnePeriodAndStopsWithoutOne) {
  Arm arm;
  ArmServo servo(arm.scene, arm.robot, kJoints, 20.0, 0.0);
  const Eigen::Vector2d rate(0.3, -0.2);
  for (int step = 0; step < 1000; ++step) {
    if (step % 10 == 0) servo.command(rate * arm.time, rate, arm.time);
    arm.step(servo);
  }
  EXPECT_LT((arm.positions() - rate * arm.time).norm(), 0.01 * rate.norm());
  const Eigen::Vector2d last_command = rate * 0.99;
  for (int step = 0; step < 1000; ++step) arm.step(servo);
  EXPECT_LT(arm.velocities().norm(), 1e-6);
  EXPECT_LT((arm.positions() - last_command).norm(), 1e-5);
}

// After a step that needs neither all speed nor all torque: q(t) = goal (1 - exp(-gain t)).
TEST(ArmServo, RespondsToAStepAsAFirstOrderLag) {
  Arm arm;
  ArmServo servo(arm.scene, arm.robot, kJoints, 20.0, 0.0);
  const Eigen::Vector2d goal(0.004, -0.002);
  servo.command(goal, Eigen::Vector2d::Zero(), arm.time);
  for (int step = 1; step <= 200; ++step) {
    arm.step(servo);
    const double share = 1.0 - std::exp(-20.0 * arm.time);
    EXPECT_LT((arm.positions() - share * goal).norm(), 0.02 * goal.norm()) << arm.time;
  }
}

TEST(ArmServo, TakesOneCommandEveryTenMillisecondsAfterTheLatency) {
  Arm arm;
  ArmServo servo(arm.scene, arm.robot, kJoints, 20.0, 0.03);
  const Eigen::Vector2d rate(0.05, -0.03);
  for (int i = 0; i < 5; ++i) servo.command(Eigen::Vector2d::Zero(), (i % 2) * rate, arm.time);
  // Commands 1 and 3 move, from 40 and 60 ms on for one period each; 0, 2 and 4 stop.
  for (int step = 0; step < 100; ++step) {
    arm.step(servo);
    const bool moves = (step >= 40 && step < 50) || (step >= 60 && step < 70);
    const double speed = arm.velocities().norm() / rate.norm();
    EXPECT_TRUE(moves ? speed > 0.7 : speed < 0.4) << step << ": " << speed;
  }
}

TEST(ArmServo, ContinuousJointTakesTheShorterWay) {
  Arm arm;
  ArmServo servo(arm.scene, arm.robot, kJoints, 20.0, 0.0);
  servo.command(Eigen::Vector2d(0.0, 5.0), Eigen::Vector2d::Zero(), arm.time);
  for (int step = 0; step < 3000; ++step) arm.step(servo);
  EXPECT_NEAR(arm.positions()[1], 5.0 - 2.0 * 3.14159265358979323846, 1e-6);
}

TEST(ArmServo, RefusesJointsWithoutLimits) {
  const std::string urdf =
      "<robot name='p'><link name='base'/><link name='rod'>" +
      inertial(1.0, "0 0 -0.5", "ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.001'") +
      "</link><joint name='pivot' type='continuous'><parent link='base'/><child link='rod'/>"
      "<axis xyz='0 1 0'/></joint></robot>";
  BulletScene scene(kTimeStep);
  RobotModel robot(scene, urdf, RobotModel::Base::kFixed, untouchable);
  EXPECT_THROW(ArmServo(scene, robot, {"pivot"}, 20.0, 0.0), std::invalid_argument);
  EXPECT_THROW(ArmServo(scene, robot, {"hinge"}, 20.0, 0.0), std::invalid_argument);
}

TEST(CompliantArm, StaysWhereItIsLeft) {
  Arm arm;
  arm.robot.set_position(arm.robot.joint("shoulder"), 1.2);
  arm.robot.update_poses();
  CompliantArm drive(arm.scene, arm.robot, kJoints, "tip");
  const Eigen::Vector2d start = arm.positions();
  for (int step = 0; step < 5000; ++step) arm.step(drive);
  EXPECT_LT((arm.positions() - start).norm(), 1e-3);
}

TEST(CompliantArm, YieldsToAHandThatPulls) {
  Arm arm;
  arm.robot.set_position(arm.robot.joint("shoulder"), 1.2);
  arm.robot.update_poses();
  CompliantArm drive(arm.scene, arm.robot, kJoints, "tip");
  const Eigen::Vector3d start = arm.robot.frame("tip").pose.translation();
  drive.apply_hand_wrench(Eigen::Vector3d(0.0, 0.0, 8.0), Eigen::Vector3d::Zero());
  double fastest = 0.0;
  for (int step = 0; step < 500; ++step) {
    arm.step(drive);
    fastest = std::max(fastest, arm.velocities().norm());
  }
  EXPECT_GT(arm.robot.frame("tip").pose.translation().z() - start.z(), 0.02);
  EXPECT_LT(fastest, 20.0);
}

}  // namespace
}  // namespace platform_sim
