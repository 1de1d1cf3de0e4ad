// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/leg_model.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "v60_gait/stance.hpp"

namespace v60_gait {
namespace {

std::string robot_urdf() {
  std::ifstream file(ROBOT_URDF_FILE);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

const Eigen::Vector3d kAngles(0.12, 0.7, 1.4);
constexpr double kDifference = 1e-6;

TEST(LegModel, JacobianIsTheSlopeOfTheToe) {
  const RigidTree robot = rigid_tree_from_urdf(robot_urdf(), false);
  for (const char* name : kLegNames) {
    const LegModel leg(robot, name);
    const Eigen::Matrix3d jacobian = leg.jacobian(kAngles);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kDifference * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d slope =
          (leg.toe(kAngles + step) - leg.toe(kAngles - step)) / (2.0 * kDifference);
      EXPECT_LT((jacobian.col(i) - slope).norm(), 1e-8) << name << " joint " << i;
    }
  }
}

TEST(LegModel, AnglesPutTheToeWhereItIsAskedFor) {
  const RigidTree robot = rigid_tree_from_urdf(robot_urdf(), false);
  for (const char* name : kLegNames) {
    const LegModel leg(robot, name);
    const Eigen::Vector3d found = leg.angles(leg.toe(kAngles), Eigen::Vector3d(0.0, 0.83, 1.65));
    EXPECT_LT((found - kAngles).norm(), 1e-9) << name;
    EXPECT_THROW((void)leg.angles(Eigen::Vector3d(0.0, 0.0, -2.0), kAngles), std::invalid_argument);
  }
}

TEST(Stance, IsTheMeasuredPostureOfTheRealRobot) {
  const Stance stance = find_stance(rigid_tree_from_urdf(robot_urdf(), false));
  for (int leg = 0; leg < 4; ++leg) {
    EXPECT_NEAR(std::abs(stance.posture[3 * leg]), 0.104, 0.02);
    EXPECT_NEAR(stance.posture[3 * leg + 1], 0.85, 0.06);
    EXPECT_NEAR(stance.posture[3 * leg + 2], 1.64, 0.03);
  }
}

}  // namespace
}  // namespace v60_gait
