// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/command_gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "follower_limits.hpp"

namespace prf_control {
namespace {

constexpr double kMaxLag = 0.2;

MotionLimits limits() {
  const auto& joints = jaco_kinematics::jaco_joint_limits();
  return {joints.lower, joints.upper, 0.95 * joints.velocity, JointVector::Constant(7, 4.0),
          JointVector::Constant(7, 6.0)};
}

// A step that keeps every bound, from a moving arm.
GateInput good_input() {
  GateInput input;
  input.before = {home(), JointVector::Constant(7, 0.3)};
  input.wanted.velocity = JointVector::Constant(7, 0.33);
  input.wanted.position = home() + kDt * input.wanted.velocity;
  input.measured = home() - JointVector::Constant(7, 0.05);
  input.dt = kDt;
  return input;
}

void move_with(GateInput& input, int joint, double velocity) {
  input.wanted.velocity[joint] = velocity;
  input.wanted.position[joint] = input.before.position[joint] + velocity * kDt;
}

TEST(CommandGate, PassesWhatKeepsEveryBoundUnchanged) {
  const GateOutput output = pass_gate(good_input(), limits(), kMaxLag);
  EXPECT_EQ(output.refusal, "");
  EXPECT_EQ(output.command.position, good_input().wanted.position);
  EXPECT_FALSE(output.anew);
}

// Fault 37: whatever a defect in the controller asks for -> the gate refuses it and brakes instead
TEST(CommandGate, RefusesEachBreachAndBrakes) {
  const double nan = std::nan("");
  const std::vector<std::pair<const char*, std::function<void(GateInput&)>>> breaches = {
      {"position beside", [](GateInput& input) { input.wanted.position[3] += 1.52; }},
      {"position beside", [nan](GateInput& input) { input.wanted.position[3] = nan; }},
      {"position beside", [nan](GateInput& input) { input.wanted.velocity[6] = nan; }},
      {"position beside", [](GateInput& input) { input.wanted.velocity[6] = INFINITY; }},
      {"change of speed", [](GateInput& input) { move_with(input, 2, 0.3 + 4.1 * kDt); }},
      {"change of speed", [](GateInput& input) { move_with(input, 2, 0.3 - 6.1 * kDt); }},
      {"speed", [](GateInput& input) {
         input.before.velocity[5] = 0.79;
         move_with(input, 5, 0.80);
       }}};
  for (const auto& [what, breach] : breaches) {
    GateInput input = good_input();
    breach(input);
    const GateOutput output = pass_gate(input, limits(), kMaxLag);
    EXPECT_NE(output.refusal.find(what), std::string::npos) << output.refusal << " not " << what;
    EXPECT_FALSE(output.anew);
    const JointVector speed = output.command.velocity;
    EXPECT_TRUE((speed.array() < input.before.velocity.array()).all());
    EXPECT_LE((input.before.velocity - speed).maxCoeff(), 6.0 * kDt + 1e-12);
    EXPECT_LE((output.command.position - input.before.position - kDt * speed).norm(), 1e-12);
  }
}

TEST(CommandGate, RefusesToLeaveTheLimits) {
  GateInput input = good_input();
  input.before = {home(), JointVector::Zero(7)};
  input.before.position[1] = limits().lower[1] + 1e-4;
  input.measured = input.before.position;
  input.wanted = input.before;
  move_with(input, 1, -0.03);
  EXPECT_NE(pass_gate(input, limits(), kMaxLag).refusal.find("position"), std::string::npos);
  input.before.position[1] = limits().lower[1] - 0.1;
  input.measured = input.before.position;
  input.wanted = input.before;
  EXPECT_EQ(pass_gate(input, limits(), kMaxLag).refusal, "") << "it may stay";
  move_with(input, 1, 0.03);
  EXPECT_EQ(pass_gate(input, limits(), kMaxLag).refusal, "") << "it may come back";
  move_with(input, 1, -0.03);
  EXPECT_NE(pass_gate(input, limits(), kMaxLag).refusal, "") << "it may not go farther";
}

TEST(CommandGate, BeginsAnewWhereTheCommandIsTooFarFromTheArm) {
  GateInput input = good_input();
  (*input.measured)[0] += 0.5;
  const GateOutput output = pass_gate(input, limits(), kMaxLag);
  EXPECT_NE(output.refusal.find("distance from the measured joint"), std::string::npos);
  EXPECT_TRUE(output.anew);
  EXPECT_EQ(output.command.position, *input.measured);
  EXPECT_EQ(output.command.velocity, JointVector::Zero(7));
}

}  // namespace
}  // namespace prf_control
