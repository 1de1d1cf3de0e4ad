// SPDX-License-Identifier: BSD-3-Clause
#include "robot_description.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace prf_control {
namespace {

using prf_robots::Robot;

const Robot& robot() {
  static const Robot jaco = prf_robots::load_robot(ROBOT_FOLDER);
  return jaco;
}

std::string refusal(const std::string& urdf, const Robot& arm = robot()) {
  try {
    require_same_arm(urdf, arm);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

// The joint's element of the model, with one text in it replaced.
std::string with(const std::string& joint, const std::string& old, const std::string& text) {
  std::string urdf = robot().urdf;
  const auto begin = urdf.find("<joint name=\"" + joint + "\"");
  const auto at = urdf.find(old, begin);
  EXPECT_LT(at, urdf.find("</joint>", begin)) << joint << ": " << old;
  return urdf.replace(at, old.size(), text);
}

void expect_refusal(const std::string& reason, const std::string& words) {
  EXPECT_NE(reason.find(words), std::string::npos) << "'" << reason << "' not '" << words << "'";
}

TEST(RobotDescription, OfTheArmIsAccepted) { EXPECT_EQ(refusal(robot().urdf), ""); }

// Fault 45: robot_description of another arm -> the controller refuses to start and says what
// differs
TEST(RobotDescription, OfAnotherArmIsRefused) {
  Robot other = robot();
  other.joints[0] = "panda_joint1";
  expect_refusal(refusal(robot().urdf, other), "not [panda_joint1, j2s7s300_joint_2");
  other = robot();
  other.tip_link = "panda_hand";
  expect_refusal(refusal(robot().urdf, other), "no link \"panda_hand\"");
  other = robot();
  other.tip_link = "j2s7s300_link_6";
  expect_refusal(refusal(robot().urdf, other), "are [j2s7s300_joint_1");
  expect_refusal(refusal("<robot"), "does not fit the robot");
  expect_refusal(refusal(""), "does not fit the robot");
}

// Fault 45: one limit, type, axis or length of the arm differs -> refused with the joint and both
// values
TEST(RobotDescription, OfAChangedArmIsRefused) {
  const std::string joint = "j2s7s300_joint_4";
  expect_refusal(refusal(with(joint, "type=\"revolute\"", "type=\"continuous\"")),
                 "lower limit of " + joint + " is -inf");
  expect_refusal(refusal(with(joint, "lower=\"0", "lower=\"1")),
                 "lower limit of " + joint + " is 1");
  expect_refusal(refusal(with(joint, "velocity=\"0", "velocity=\"1")),
                 "velocity limit of " + joint + " is 1");
  EXPECT_NE(refusal(with(joint, "lower=\"0", "lower=\"nan\" was=\"0")), "");
  expect_refusal(refusal(with(joint, "<axis xyz=\"0 0 1\"", "<axis xyz=\"0 0 -1\"")),
                 "the axis of " + joint + " differs by 2 rad");
  expect_refusal(refusal(with(joint, "<axis xyz=\"0 0 1\"", "<axis xyz=\"0 0 0\"")), joint);
  expect_refusal(refusal(with(joint, "xyz=\"0 ", "xyz=\"0.001 ")),
                 "j2s7s300_end_effector is 0.001 m");
}

}  // namespace
}  // namespace prf_control
