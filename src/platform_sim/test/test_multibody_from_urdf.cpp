// SPDX-License-Identifier: BSD-3-Clause
#include "physics/multibody_from_urdf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "small_robots.hpp"
#include "v60_gait/gravity.hpp"
#include "v60_gait/leg_model.hpp"
#include "v60_world.hpp"

namespace platform_sim {
namespace {

constexpr double kTimeStep = 0.001;
constexpr double kPi = 3.14159265358979323846;

Eigen::Isometry3d transform(double x, double y, double z, double roll, double pitch, double yaw) {
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

struct TwoLinks {
  BulletScene scene{kTimeStep};
  RobotModel robot{scene, two_link_robot(), RobotModel::Base::kFixed, untouchable};

  void pose(double shoulder, double elbow) {
    robot.set_position(robot.joint("shoulder"), shoulder);
    robot.set_position(robot.joint("elbow"), elbow);
    robot.update_poses();
  }
};

TEST(RobotModel, FramesFollowTheJointOriginsOfTheUrdf) {
  TwoLinks two;
  for (double angle = -2.5; angle < 2.6; angle += 0.7) {
    const double elbow = 0.3 - 2.0 * angle;
    two.pose(angle, elbow);
    const Eigen::Isometry3d tip =
        transform(0, 0, 1, 0.3, 0.1, -0.2) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()) *
        transform(0.1, 0, -0.5, -0.5, 0.4, 0.7) *
        Eigen::AngleAxisd(elbow, Eigen::Vector3d(0.6, 0.8, 0.0)) *
        transform(0.05, 0, -0.4, 0.2, 0.3, 0.4) * transform(0.1, 0.2, 0.3, 1.0, 0.0, 0.0);
    EXPECT_TRUE(two.robot.frame("tip").pose.isApprox(tip, 1e-12));
  }
}

TEST(RobotModel, TwistOfAFrameIsTheDerivativeOfItsPose) {
  TwoLinks two;
  two.pose(0.9, -0.4);
  two.robot.multibody().setJointVel(0, 0.7);
  two.robot.multibody().setJointVel(1, -1.1);
  const FrameState tip = two.robot.frame("tip");
  constexpr double kDifference = 1e-6;
  two.pose(0.9 + 0.7 * kDifference, -0.4 - 1.1 * kDifference);
  const Eigen::Isometry3d after = two.robot.frame("tip").pose;
  const Eigen::AngleAxisd turn(after.linear() * tip.pose.linear().transpose());
  EXPECT_LT((tip.linear - (after.translation() - tip.pose.translation()) / kDifference).norm(),
            1e-5);
  EXPECT_LT((tip.angular - turn.axis() * turn.angle() / kDifference).norm(), 1e-5);
}

double potential_energy(const RobotModel& robot) {
  return -robot.mass() * robot.gravity().dot(robot.centre_of_mass());
}

double kinetic_energy(const RobotModel& robot) {
  double energy = 0.0;
  for (const v60_gait::RigidBody& body : robot.tree().bodies) {
    const FrameState link = robot.frame(body.name);
    const Eigen::Matrix3d& rotation = link.pose.linear();
    const Eigen::Vector3d velocity =
        link.linear + link.angular.cross(rotation * body.centre_of_mass);
    const Eigen::Vector3d rate = rotation.transpose() * link.angular;
    energy += 0.5 * (body.mass * velocity.squaredNorm() + rate.dot(body.inertia * rate));
  }
  return energy;
}

TEST(RobotModel, GravityTorquesAreTheSlopeOfThePotentialEnergy) {
  TwoLinks two;
  constexpr double kDifference = 1e-6;
  two.pose(0.5, 1.2);
  const Eigen::VectorXd torques = two.robot.gravity_torques();
  two.pose(0.5 + kDifference, 1.2);
  const double shoulder_up = potential_energy(two.robot);
  two.pose(0.5 - kDifference, 1.2);
  EXPECT_NEAR(torques[0], -(shoulder_up - potential_energy(two.robot)) / (2 * kDifference), 1e-6);
  two.pose(0.5, 1.2 + kDifference);
  const double elbow_up = potential_energy(two.robot);
  two.pose(0.5, 1.2 - kDifference);
  EXPECT_NEAR(torques[1], -(elbow_up - potential_energy(two.robot)) / (2 * kDifference), 1e-6);
}

// A wrench on the tip against the torques of virtual work: both must leave a balanced robot still.
TEST(RobotModel, WrenchOnAFrameDoesTheWorkOfItsJacobian) {
  TwoLinks two;
  two.scene.world().setGravity(btVector3(0, 0, 0));
  const Eigen::Vector3d force(3.0, -2.0, 5.0);
  const Eigen::Vector3d torque(0.4, 0.2, -0.3);
  Eigen::Vector2d balance;
  for (int joint = 0; joint < 2; ++joint) {
    two.pose(0.5, 1.2);
    two.robot.set_at_rest();
    two.robot.multibody().setJointVel(joint, 1.0);
    const FrameState tip = two.robot.frame("tip");
    balance[joint] = -(force.dot(tip.linear) + torque.dot(tip.angular));
  }
  two.robot.set_at_rest();
  two.robot.apply_wrench("tip", force, torque);
  two.robot.apply_torque(two.robot.joints()[0], balance[0]);
  two.robot.apply_torque(two.robot.joints()[1], balance[1]);
  two.scene.step();
  EXPECT_NEAR(two.robot.velocity(two.robot.joints()[0]), 0.0, 1e-12);
  EXPECT_NEAR(two.robot.velocity(two.robot.joints()[1]), 0.0, 1e-12);
}

TEST(RobotModel, PendulumSwingsWithItsPeriod) {
  const double length = 0.5;
  const double moment = 0.01;
  const std::string urdf =
      "<robot name='p'><link name='base'/><link name='rod'>" +
      inertial(1.0, "0 0 -0.5", "ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.001'") +
      "</link><joint name='pivot' type='continuous'><parent link='base'/><child link='rod'/>"
      "<axis xyz='0 1 0'/></joint></robot>";
  BulletScene scene(kTimeStep);
  RobotModel robot(scene, urdf, RobotModel::Base::kFixed, untouchable);
  const v60_gait::RobotJoint& pivot = robot.joint("pivot");
  const double amplitude = 0.3;
  robot.set_position(pivot, amplitude);
  robot.update_poses();
  int upward_crossings = 0;
  double first = 0.0;
  double last = 0.0;
  double before = amplitude;
  for (int step = 1; step <= 20000; ++step) {
    scene.step();
    const double angle = robot.position(pivot);
    if (before < 0.0 && angle >= 0.0) {
      last = kTimeStep * (step - angle / (angle - before));
      if (upward_crossings++ == 0) first = last;
    }
    before = angle;
  }
  ASSERT_GT(upward_crossings, 10);
  const double period = (last - first) / (upward_crossings - 1);
  // Series of the exact period of the physical pendulum at this amplitude.
  const double small = 2.0 * kPi * std::sqrt((moment + length * length) / (9.81 * length));
  const double a2 = amplitude * amplitude;
  EXPECT_NEAR(period, small * (1.0 + a2 / 16.0 + 11.0 * a2 * a2 / 3072.0), 1e-4 * small);
}

TEST(RobotModel, ChaoticSwingKeepsItsEnergy) {
  TwoLinks two;
  two.pose(1.2, 0.5);
  const auto energy = [&] { return kinetic_energy(two.robot) + potential_energy(two.robot); };
  const double start = energy();
  double lowest_potential = potential_energy(two.robot);
  double drift = 0.0;
  for (int step = 0; step < 5000; ++step) {
    two.scene.step();
    lowest_potential = std::min(lowest_potential, potential_energy(two.robot));
    drift = std::max(drift, std::abs(energy() - start));
  }
  EXPECT_GT(start - lowest_potential, 5.0);
  EXPECT_LT(drift, 0.02 * (start - lowest_potential));
}

// What an arm does to the body it stands on: without outer forces the common centre of mass rests,
// and a joint driven against the body turns the body the other way.
TEST(RobotModel, InnerTorquesMoveABodyInSpaceButNotTheCentreOfMass) {
  BulletScene scene(kTimeStep);
  scene.world().setGravity(btVector3(0.0, 0.0, 0.0));
  std::string urdf = two_link_robot();
  const std::string base = "<link name='base'/>";
  urdf.replace(
      urdf.find(base), base.size(),
      "<link name='base'>" +
          inertial(5.0, "0 0 0.1", "ixx='0.1' ixy='0' ixz='0' iyy='0.12' iyz='0' izz='0.08'") +
          "</link>");
  RobotModel robot(scene, urdf, RobotModel::Base::kFloating, untouchable);
  robot.update_poses();
  const Eigen::Vector3d centre = robot.centre_of_mass();
  const Eigen::Isometry3d before = robot.frame("base").pose;
  double farthest = 0.0;
  for (int step = 0; step < 1000; ++step) {
    robot.apply_torque(robot.joint("shoulder"), 0.5 * std::cos(6.0 * step * kTimeStep));
    robot.apply_torque(robot.joint("elbow"), -0.1);
    scene.step();
    farthest = std::max(farthest, (robot.centre_of_mass() - centre).norm());
  }
  const Eigen::Isometry3d after = robot.frame("base").pose;
  EXPECT_GT((after.translation() - before.translation()).norm(), 0.01);
  EXPECT_GT(Eigen::AngleAxisd(after.linear() * before.linear().transpose()).angle(), 0.05);
  EXPECT_LT(farthest, 1e-3);
}

TEST(RobotModel, AgreesWithTheLegModelAboutTheWeightOfALeg) {
  const Eigen::Vector3d kAngles(0.12, 0.7, 1.4);
  BulletScene scene(kTimeStep);
  RobotModel robot(scene, robot_urdf(), RobotModel::Base::kFloating, [](const std::string&) {
    return RobotSurface{"", {0, 0}, 0.5, 1e5, 1e3};
  });
  const v60_gait::LegModel leg(robot.tree(), "rr");
  int i = 0;
  for (const char* joint : {"rr_abduction", "rr_hip", "rr_knee"}) {
    robot.set_position(robot.joint(joint), kAngles[i++]);
  }
  robot.update_poses();
  const Eigen::Vector3d torques =
      leg.weight_torques(kAngles, Eigen::Vector3d(0.0, 0.0, -v60_gait::kGravity));
  const Eigen::VectorXd gravity = robot.gravity_torques();
  i = 0;
  for (const char* joint : {"rr_abduction", "rr_hip", "rr_knee"}) {
    EXPECT_NEAR(torques[i++], -gravity[robot.joint(joint).body - 1], 1e-10) << joint;
  }
}

TEST(RobotModel, PositionLimitStopsAJoint) {
  TwoLinks two;
  two.pose(2.9, 0.0);
  for (int step = 0; step < 1000; ++step) {
    two.robot.apply_torque(two.robot.joint("shoulder"), 60.0);
    two.scene.step();
    EXPECT_LT(two.robot.position(two.robot.joint("shoulder")), 3.01);
  }
}

TEST(RobotModel, FixedPartsCountWithMassAndInertia) {
  const v60_gait::RigidTree tree = v60_gait::rigid_tree_from_urdf(two_link_robot(), true);
  ASSERT_EQ(tree.bodies.size(), 3u);
  const v60_gait::RigidBody& lower = tree.bodies[2];
  EXPECT_DOUBLE_EQ(lower.mass, 1.5);
  const Eigen::Isometry3d weight = transform(0.05, 0, -0.4, 0.2, 0.3, 0.4);
  const Eigen::Vector3d first(0, 0.03, -0.2);
  const Eigen::Vector3d second = weight * Eigen::Vector3d(0.01, 0, 0);
  EXPECT_TRUE(lower.centre_of_mass.isApprox((first + 0.5 * second) / 1.5, 1e-12));
  // The trace of the inertia is twice the second moment of mass, whatever the axes.
  const double trace = 0.05 + 0.005 + (2.0 / 3.0) * (first - second).squaredNorm();
  EXPECT_NEAR(lower.inertia.trace(), trace, 1e-12);
}

TEST(RobotModel, RefusesRobotsThatCannotBeSimulated) {
  const std::string solid =
      inertial(1.0, "0 0 0", "ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'");
  const auto robot = [](const std::string& link_content, const std::string& joint_type) {
    return "<robot name='r'><link name='base'/><link name='arm'>" + link_content +
           "</link><joint name='j' type='" + joint_type +
           "'><parent link='base'/><child link='arm'/><axis xyz='0 0 1'/>"
           "<limit lower='-1' upper='1' velocity='1' effort='1'/></joint></robot>";
  };
  const auto refuses = [](const std::string& urdf) {
    EXPECT_THROW((void)v60_gait::rigid_tree_from_urdf(urdf, true), std::invalid_argument) << urdf;
  };
  EXPECT_NO_THROW((void)v60_gait::rigid_tree_from_urdf(robot(solid, "revolute"), true));
  refuses("");
  refuses("no xml");
  refuses("<robot name='r'></robot>");
  refuses(robot("", "revolute"));
  refuses(
      robot(inertial(0.0, "0 0 0", "ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'"), "revolute"));
  refuses(
      robot(inertial(1.0, "0 0 0", "ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='3'"), "revolute"));
  refuses(
      robot(inertial(1.0, "0 0 0", "ixx='0' ixy='0' ixz='0' iyy='0' iyz='0' izz='0'"), "revolute"));
  refuses(robot(solid, "prismatic"));
  refuses(robot(solid + "<collision><geometry><mesh filename='a.stl'/></geometry></collision>",
                "revolute"));
  EXPECT_THROW((void)v60_gait::rigid_tree_from_urdf(two_link_robot(), false),
               std::invalid_argument);
}

// Fault 54: masses, inertias or limits in the URDF negative, absurd, not finite -> refused by name
TEST(RobotModel, RefusesNumbersThatNoRobotHas) {
  const auto spoilt = [](const std::string& from, const std::string& to) {
    std::string urdf = two_link_robot();
    urdf.replace(urdf.find(from), from.size(), to);
    try {
      (void)v60_gait::rigid_tree_from_urdf(urdf, true);
      return std::string("accepted");
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
  };
  const std::string mass = "<mass value='0.500000'/>", inertia = "ixx='0.002'";
  for (const char* value : {"-0.1", "1e300", "nan", "inf"}) {
    const std::string number = std::string("'") + value + "'";
    EXPECT_NE(spoilt(mass, "<mass value=" + number + "/>"), "accepted") << number;
    EXPECT_NE(spoilt(inertia, "ixx=" + number), "accepted") << number;
    EXPECT_NE(spoilt("effort='60'", "effort=" + number), "accepted") << number;
  }
  EXPECT_EQ(spoilt(mass, "<mass value='-0.1'/>"),
            "mass of link \"weight\" = -0.1, must be within [0, 10000] kg");
}

}  // namespace
}  // namespace platform_sim
