// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <limits>
#include <stdexcept>
#include <string>

#include "jaco_kinematics/jaco_kinematics.hpp"
#include "random_joints.hpp"

namespace jaco_kinematics {
namespace {

using Matrix4 = Eigen::Matrix4d;

Matrix4 rotation_about(int axis, double angle) {
  const int i = (axis + 1) % 3;
  const int j = (axis + 2) % 3;
  Matrix4 m = Matrix4::Identity();
  m(i, i) = m(j, j) = std::cos(angle);
  m(j, i) = std::sin(angle);
  m(i, j) = -m(j, i);
  return m;
}

// The joint origins as the vendor's file lists them (x y z roll pitch yaw), multiplied out.
Matrix4 product_of_joint_origins(const JointVector& q) {
  constexpr double kHalf = M_PI / 2.0;
  const double origins[8][6] = {
      {0, 0, 0.15675, 0, M_PI, 0},           {0, 0.0016, -0.11875, -kHalf, 0, M_PI},
      {0, -0.205, 0, -kHalf, 0, 0},          {0, 0, -0.205, kHalf, 0, M_PI},
      {0, 0.2073, -0.0114, -kHalf, 0, M_PI}, {0, 0, -0.10375, kHalf, 0, M_PI},
      {0, 0.10375, 0, -kHalf, 0, M_PI},      {0, 0, -0.16, M_PI, 0, kHalf}};
  Matrix4 pose = Matrix4::Identity();
  for (int i = 0; i < 8; ++i) {
    Matrix4 shift = Matrix4::Identity();
    shift.topRightCorner<3, 1>() << origins[i][0], origins[i][1], origins[i][2];
    pose = pose * shift * rotation_about(2, origins[i][5]) * rotation_about(1, origins[i][4]) *
           rotation_about(0, origins[i][3]) * rotation_about(2, i < 7 ? q[i] : 0.0);
  }
  return pose;
}

KDL::Chain arm_of_urdf() {
  KDL::Tree tree;
  KDL::Chain chain;
  if (!kdl_parser::treeFromFile(URDF_FILE, tree) ||
      !tree.getChain("j2s7s300_link_base", "j2s7s300_end_effector", chain)) {
    throw std::runtime_error("no arm in " URDF_FILE);
  }
  return chain;
}

TEST(JacoJointLimits, AreThoseOfTheUrdf) {
  const auto model = urdf::parseURDFFile(URDF_FILE);
  ASSERT_TRUE(model);
  const JointLimits& limits = jaco_joint_limits();
  for (int i = 0; i < 7; ++i) {
    const auto joint = model->getJoint("j2s7s300_joint_" + std::to_string(i + 1));
    ASSERT_TRUE(joint && joint->limits);
    EXPECT_NEAR(joint->limits->velocity, limits.velocity[i], 1e-12);
    EXPECT_NEAR(joint->limits->effort, limits.effort[i], 1e-12);
    if (std::isinf(limits.upper[i])) {
      EXPECT_EQ(joint->type, urdf::Joint::CONTINUOUS);
    } else {
      EXPECT_EQ(joint->type, urdf::Joint::REVOLUTE);
      EXPECT_NEAR(joint->limits->lower, limits.lower[i], 1e-12);
      EXPECT_NEAR(joint->limits->upper, limits.upper[i], 1e-12);
    }
  }
}

TEST(JacoForward, EqualsTheProductOfTheJointOrigins) {
  std::mt19937 generator(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const JointVector q = random_joints(&generator);
    const Matrix4 difference = forward(q).matrix() - product_of_joint_origins(q);
    ASSERT_LT(difference.cwiseAbs().maxCoeff(), 1e-12) << q.transpose();
  }
}

TEST(JacoForward, EqualsKdlOnTheUrdf) {
  const KDL::Chain chain = arm_of_urdf();
  ASSERT_EQ(chain.getNrOfJoints(), 7u);
  KDL::ChainFkSolverPos_recursive solver(chain);
  std::mt19937 generator(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const JointVector q = random_joints(&generator);
    KDL::JntArray joints(7);
    joints.data = q;
    KDL::Frame frame;
    ASSERT_GE(solver.JntToCart(joints, frame), 0);
    const Eigen::Isometry3d pose = forward(q);
    for (int row = 0; row < 3; ++row) {
      ASSERT_NEAR(pose.translation()[row], frame.p[row], 1e-12);
      for (int column = 0; column < 3; ++column) {
        ASSERT_NEAR(pose.linear()(row, column), frame.M(row, column), 1e-12);
      }
    }
  }
}

TEST(JacoForward, IsUnchangedByFullTurns) {
  std::mt19937 generator(3);
  const JointVector q = random_joints(&generator);
  const JointVector turned = q + JointVector::Constant(2.0 * M_PI);
  EXPECT_TRUE(forward(turned).isApprox(forward(q), 1e-12));
}

TEST(JacoJacobian, EqualsCentralDifferences) {
  constexpr double kStep = 1e-5;
  std::mt19937 generator(4);
  for (int trial = 0; trial < 200; ++trial) {
    const JointVector q = random_joints(&generator);
    const Jacobian exact = jacobian(q);
    for (int i = 0; i < 7; ++i) {
      const Eigen::Isometry3d before = forward(q - kStep * JointVector::Unit(i));
      const Eigen::Isometry3d after = forward(q + kStep * JointVector::Unit(i));
      const Eigen::Vector3d linear = (after.translation() - before.translation()) / (2.0 * kStep);
      const Eigen::Matrix3d spin =
          (after.linear() - before.linear()) / (2.0 * kStep) * forward(q).linear().transpose();
      const Eigen::Vector3d angular(spin(2, 1), spin(0, 2), spin(1, 0));
      ASSERT_LT((exact.col(i).head<3>() - linear).norm(), 1e-9);
      ASSERT_LT((exact.col(i).tail<3>() - angular).norm(), 1e-9);
    }
  }
}

// Fault 43: joint angles that are not finite or beyond any arm -> refused by every function
TEST(JacoForward, RefusesJointsThatAreNoAngles) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1.1e4, -1e300}) {
    JointVector q = JointVector::Constant(M_PI);
    q[4] = bad;
    EXPECT_THROW(forward(q), std::invalid_argument);
    EXPECT_THROW(jacobian(q), std::invalid_argument);
    EXPECT_THROW(arm_angle(q), std::invalid_argument);
  }
}

}  // namespace
}  // namespace jaco_kinematics
