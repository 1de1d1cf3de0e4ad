// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/setpoint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace prf_control {
namespace {

const Eigen::Vector3d kZero = Eigen::Vector3d::Zero();
const Eigen::Vector4d kIdentity(0.0, 0.0, 0.0, 1.0);

TEST(CheckedSetpoint, TakesAPoseAndItsVelocity) {
  const Setpoint setpoint =
      checked_setpoint({0.4, 0.1, 0.5}, {0.5, 0.5, 0.5, 0.5}, {0.1, 0.0, -0.1}, {0.0, 0.2, 0.0});
  ASSERT_EQ(setpoint.kind, SetpointKind::kPose);
  Eigen::Matrix3d cyclic;
  cyclic << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  EXPECT_TRUE(setpoint.pose.hand_in_base.linear().isApprox(cyclic, 1e-15));
  EXPECT_EQ(setpoint.pose.hand_in_base.translation(), Eigen::Vector3d(0.4, 0.1, 0.5));
  EXPECT_EQ(setpoint.pose.linear_velocity, Eigen::Vector3d(0.1, 0.0, -0.1));
  EXPECT_EQ(setpoint.pose.angular_velocity, Eigen::Vector3d(0.0, 0.2, 0.0));
}

TEST(CheckedSetpoint, NormalisesAQuaternionThatIsNearlyUnit) {
  const Eigen::Vector4d nearly_unit = 1.005 * Eigen::Vector4d(0.5, 0.5, 0.5, 0.5);
  const Setpoint setpoint = checked_setpoint(kZero, nearly_unit, kZero, kZero);
  ASSERT_EQ(setpoint.kind, SetpointKind::kPose);
  const Eigen::Matrix3d rotation = setpoint.pose.hand_in_base.linear();
  EXPECT_TRUE((rotation * rotation.transpose()).isIdentity(1e-15));
}

TEST(CheckedSetpoint, RefusesQuaternionsThatAreNoRotation) {
  const double nan = std::nan("");
  for (const Eigen::Vector4d& quaternion :
       {Eigen::Vector4d(0, 0, 0, 0), Eigen::Vector4d(0, 0, 0, 1.011),
        Eigen::Vector4d(0, 0, 0, 0.989), Eigen::Vector4d(0, 0, nan, 1)}) {
    const Setpoint setpoint = checked_setpoint(kZero, quaternion, kZero, kZero);
    EXPECT_EQ(setpoint.kind, SetpointKind::kInvalid);
    EXPECT_NE(setpoint.refusal.find("quaternion"), std::string::npos);
  }
}

TEST(CheckedSetpoint, RefusesNumbersThatAreNotFiniteOrBeyondAnyArm) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, -2e3}) {
    const Eigen::Vector3d vector(0.0, bad, 0.0);
    EXPECT_NE(checked_setpoint(vector, kIdentity, kZero, kZero).refusal.find("position"),
              std::string::npos);
    EXPECT_NE(checked_setpoint(kZero, kIdentity, vector, kZero).refusal.find("linear velocity"),
              std::string::npos);
    EXPECT_NE(checked_setpoint(kZero, kIdentity, kZero, vector).refusal.find("angular velocity"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace prf_control
