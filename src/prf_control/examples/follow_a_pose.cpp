// SPDX-License-Identifier: BSD-3-Clause
// Follows a hand pose that moves to the left at 0.1 m/s for one second, and prints how far the
// commanded hand is from it.
#include <iostream>
#include <jaco_kinematics/jaco_arm.hpp>
#include <memory>
#include <prf_control/setpoint_follower.hpp>

int main() {
  using namespace prf_control;
  FollowerParams params{};
  params.velocity_scale = 0.95;
  params.acceleration = 4.0;
  params.max_joint_step = 0.3;
  params.far_position = 0.1;
  params.far_orientation = 0.5;
  params.damping = 0.1;
  params.orientation_weight = 0.2;
  params.branch_patience = 1.0;

  JointVector measured(7);  // rad
  measured << 0.3, 3.9, 0.2, 1.9, 0.4, 2.4, -0.3;
  const auto arm = std::make_shared<jaco_kinematics::JacoArm>();
  SetpointFollower follower(arm, params);
  follower.start(measured);

  constexpr double kPeriod = 0.01;  // s
  PoseSetpoint setpoint;
  setpoint.hand_in_base = arm->forward(measured);
  setpoint.linear_velocity.y() = 0.1;
  FollowerStep step;
  for (int tick = 0; tick < 100; ++tick) {
    setpoint.hand_in_base.translation().y() += 0.1 * kPeriod;
    step = follower.follow(setpoint, kPeriod);  // step.motion.state is the command
  }
  std::cout << "joints [rad]: " << step.motion.state.position.transpose() << "\n"
            << "hand to set-point: " << step.position_deviation << " m\n";
  return step.position_deviation < 1e-6 ? 0 : 1;
}
