// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/robot_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "small_arm.hpp"

namespace prf_drivers {
namespace {

RobotShapes shapes() { return {small_arm(), "base", kSmallArm}; }

TEST(RobotShapes, MeasuresWhatTwoJointsAreBetween) {
  RobotShapes arm = shapes();
  // Folded back by two right angles: link three runs beside link one, 0.4 m away, less a width.
  arm.place(three(0.0, M_PI_2, M_PI_2), {});
  const Clearances found = arm.between_bodies(1.0);
  EXPECT_NEAR(found.at("one and three"), 0.36, 1e-6);
  EXPECT_NEAR(found.at("base and two"), std::hypot(0.38, 0.05) - 0.05, 1e-6);
  EXPECT_EQ(found.count("one and two"), 0U);
}

TEST(RobotShapes, KnowsNothingBeyondTheDistanceAskedFor) {
  RobotShapes arm = shapes();
  arm.place(three(0.0, 0.0, 0.0), {});
  EXPECT_TRUE(arm.between_bodies(0.1).empty());
}

TEST(RobotShapes, HasBodiesThatOverlapAtDistanceZero) {
  RobotShapes arm = shapes();
  arm.place(three(0.0, 2.4, 2.4), {});  // an almost closed triangle: three crosses one
  EXPECT_EQ(arm.between_bodies(1.0).at("one and three"), 0.0);
}

TEST(RobotShapes, PlacesJointsThatAreNotTheArms) {
  RobotShapes arm = shapes();
  arm.place(three(0.35, 0.0, 0.0), {});
  const double up = arm.between_bodies(1.0).at("three and flag");
  arm.place(three(0.35, 0.0, 0.0), {{"d", -0.25}});
  EXPECT_LT(arm.between_bodies(1.0).at("three and flag"), up - 0.05);
}

TEST(RobotShapes, IgnoresPairsOnceTheyAreNearAsPlaced) {
  RobotShapes arm = shapes();
  arm.place(three(0.0, 2.4, 2.4), {});
  EXPECT_EQ(arm.ignore_nearer_than(0.01), std::vector<std::string>{"one and three"});
  EXPECT_EQ(arm.between_bodies(1.0).count("one and three"), 0U);
  EXPECT_EQ(arm.between_bodies(1.0).count("base and three"), 1U);
}

TEST(RobotShapes, MeasuresBoxesFromOutsideAndInside) {
  RobotShapes arm = shapes();
  arm.place(three(0.0, 0.0, 0.0), {});
  const Clearances outside = arm.outside({{1.25, -0.1, -0.1}, {1.5, 0.1, 0.1}}, "crate", 0.3);
  EXPECT_EQ(outside.size(), 1U);
  EXPECT_NEAR(outside.at("three and crate"), 0.1, 1e-6);
  const Clearances inside = arm.inside({{-1.0, -1.0, -1.0}, {1.2, 1.0, 1.0}}, 0.3);
  EXPECT_EQ(inside.size(), 1U);
  EXPECT_NEAR(inside.at("three and the workspace's wall at +x"), 0.05, 1e-9);
  arm.place(three(0.5, 0.0, 0.0), {});
  const Clearances turned = arm.inside({{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}}, 0.3);
  EXPECT_NEAR(turned.at("three and the workspace's wall at +x"),
              1.0 - 1.15 * std::cos(0.5) - 0.02 * std::sin(0.5), 1e-9);
}

TEST(RobotShapes, TakesTheRangeOfRevoluteJointsOnly) {
  const JointRange range = joint_range(small_arm(), kSmallArm);
  EXPECT_EQ(range.upper[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(range.lower[1], -3.0);
  EXPECT_EQ(range.upper[2], 2.5);
}

std::string refusal(const std::string& urdf, const std::string& base,
                    const std::vector<std::string>& arm) {
  try {
    const RobotShapes made(urdf, base, arm);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

// Fault 45: a robot description without the arm, or with meshes -> refused at the start, named
TEST(RobotShapes, RefusesWhatItCannotPlace) {
  EXPECT_NE(refusal("<robot", "base", kSmallArm).find("must be a URDF"), std::string::npos);
  EXPECT_NE(refusal(small_arm(), "nowhere", kSmallArm).find("base_link"), std::string::npos);
  EXPECT_NE(refusal(small_arm(), "base", {"a", "x"}).find("driver/joints"), std::string::npos);
  EXPECT_NE(refusal(small_arm(), "base", {}).find("without collision shapes"), std::string::npos);
  std::string mesh = small_arm();
  mesh.replace(mesh.find("<sphere radius='0.05'/>"), 23, "<mesh filename='ball.stl'/>");
  EXPECT_NE(refusal(mesh, "base", kSmallArm).find("is a mesh"), std::string::npos);
}

}  // namespace
}  // namespace prf_drivers
