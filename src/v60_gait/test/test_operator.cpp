// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/operator.hpp"

#include <gtest/gtest.h>

namespace v60_gait {
namespace {

TEST(Operator, MovesTheStickLateAndNotForASmallError) {
  Operator human(Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d off(Eigen::Translation3d(-0.1, 0.02, 0.0));
  for (int i = 0; i < 70; ++i) EXPECT_EQ(human.stick(0.01 * i, off).norm(), 0.0) << i;
  Eigen::Vector3d stick = Eigen::Vector3d::Zero();
  for (int i = 70; i < 400; ++i) stick = human.stick(0.01 * i, off);
  EXPECT_GT(stick.x(), 0.01);
  EXPECT_LT(stick.x(), 0.15);
  EXPECT_EQ(stick.y(), 0.0);
}

}  // namespace
}  // namespace v60_gait
