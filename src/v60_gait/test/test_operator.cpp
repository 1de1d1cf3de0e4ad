// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/operator.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace v60_gait {
namespace {

TEST(Operator, CommandsLateAndNotForASmallError) {
  Operator human(Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d off(Eigen::Translation3d(-0.1, 0.02, 0.0));
  for (int i = 0; i < 70; ++i) EXPECT_EQ(human.joystick(0.01 * i, off).norm(), 0.0) << i;
  Eigen::Vector3d joystick = Eigen::Vector3d::Zero();
  for (int i = 70; i < 400; ++i) joystick = human.joystick(0.01 * i, off);
  EXPECT_GT(joystick.x(), 0.01);
  EXPECT_LT(joystick.x(), 0.15);
  EXPECT_EQ(joystick.y(), 0.0);
}

TEST(Operator, SteersBackOnEachAxisUpToTheLargestCommand) {
  Operator human(Eigen::Isometry3d::Identity());
  // Far behind, far to the left and turned to the left.
  const Eigen::Isometry3d off = Eigen::Translation3d(-5.0, 5.0, 0.0) *
                                Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ());
  Eigen::Vector3d joystick = Eigen::Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) joystick = human.joystick(0.01 * i, off);
  // Its place is then 5 m behind and 5 m to the right of it, and its heading to the right.
  EXPECT_DOUBLE_EQ(joystick.x(), -0.15);
  EXPECT_DOUBLE_EQ(joystick.y(), -0.10);
  EXPECT_DOUBLE_EQ(joystick.z(), -0.2);
}

}  // namespace
}  // namespace v60_gait
