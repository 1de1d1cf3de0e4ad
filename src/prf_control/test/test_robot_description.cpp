// SPDX-License-Identifier: BSD-3-Clause
#include "robot_description.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace prf_control {
namespace {

std::string model() {
  std::ifstream file(URDF_FILE);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

ArmNames names(const std::string& prefix = "j2s7s300_joint_") {
  ArmNames names{{}, "j2s7s300_link_base", "j2s7s300_end_effector"};
  for (int i = 1; i <= 7; ++i) names.joints.push_back(prefix + std::to_string(i));
  return names;
}

std::string refusal(const std::string& urdf, const ArmNames& arm = names()) {
  try {
    require_same_arm(urdf, arm);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

// The joint's element of the model, with one text in it replaced.
std::string with(const std::string& joint, const std::string& old, const std::string& text) {
  std::string urdf = model();
  const auto begin = urdf.find("<joint name=\"" + joint + "\"");
  const auto at = urdf.find(old, begin);
  EXPECT_LT(at, urdf.find("</joint>", begin)) << joint << ": " << old;
  return urdf.replace(at, old.size(), text);
}

void expect_refusal(const std::string& reason, const std::string& words) {
  EXPECT_NE(reason.find(words), std::string::npos) << "'" << reason << "' not '" << words << "'";
}

TEST(RobotDescription, OfTheArmIsAccepted) { EXPECT_EQ(refusal(model()), ""); }

// Fault 45: robot_description of another arm -> the controller refuses to start and says what
// differs
TEST(RobotDescription, OfAnotherArmIsRefused) {
  expect_refusal(refusal(model(), names("panda_joint")), "not [panda_joint1, panda_joint2");
  ArmNames other = names();
  other.hand = "panda_hand";
  expect_refusal(refusal(model(), other), "no link panda_hand");
  other = names();
  std::swap(other.base, other.hand);
  expect_refusal(refusal(model(), other), "is not carried by");
  other = names();
  other.hand = "j2s7s300_link_6";
  expect_refusal(refusal(model(), other), "are [j2s7s300_joint_1");
  expect_refusal(refusal("<robot"), "no valid URDF");
  expect_refusal(refusal(""), "no valid URDF");
}

// Fault 45: one limit, type, axis or length of the arm differs -> refused with the joint and both
// values
TEST(RobotDescription, OfAChangedArmIsRefused) {
  const std::string joint = "j2s7s300_joint_4";
  expect_refusal(refusal(with(joint, "type=\"revolute\"", "type=\"continuous\"")),
                 joint + " is not revolute");
  expect_refusal(refusal(with(joint, "lower=\"0", "lower=\"1")),
                 "lower limit of " + joint + " is 1");
  expect_refusal(refusal(with(joint, "velocity=\"0", "velocity=\"1")),
                 "velocity limit of " + joint + " is 1");
  EXPECT_NE(refusal(with(joint, "lower=\"0", "lower=\"nan\" was=\"0")), "");
  expect_refusal(refusal(with(joint, "<axis xyz=\"0 0 1\"", "<axis xyz=\"0 0 -1\"")),
                 "the axis of " + joint + " differs by 2 rad");
  expect_refusal(refusal(with(joint, "<axis xyz=\"0 0 1\"", "<axis xyz=\"0 0 0\"")),
                 "axis of " + joint);
  expect_refusal(refusal(with(joint, "xyz=\"0 ", "xyz=\"0.001 ")),
                 "j2s7s300_end_effector is 0.001 m");
}

}  // namespace
}  // namespace prf_control
