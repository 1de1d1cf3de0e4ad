// SPDX-License-Identifier: BSD-3-Clause
// The follower's usual parameters, and the limits that each of its commands must keep.
#pragma once

#include <gtest/gtest.h>

#include <jaco_kinematics/jaco_arm.hpp>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <memory>

#include "prf_control/setpoint_follower.hpp"

namespace prf_control {

inline constexpr double kDt = 0.01;

inline Arm jaco() {
  static const Arm arm = std::make_shared<jaco_kinematics::JacoArm>();
  return arm;
}

inline FollowerParams params() { return {0.95, 4.0, 0.3, 0.1, 0.5, 0.1, 0.2, 1.0}; }

inline JointVector home() {
  return (JointVector(7) << 0.3, 3.9, 0.2, 1.9, 0.4, 2.4, -0.3).finished();
}

// Every command: finite, within position, velocity and acceleration limits.
inline void expect_within_limits(const MotionState& before, const MotionState& after, double dt) {
  const auto& joints = jaco_kinematics::jaco_joint_limits();
  ASSERT_TRUE(after.position.allFinite());
  ASSERT_TRUE(after.velocity.allFinite());
  ASSERT_GE((after.position - joints.lower).minCoeff(), 0.0);
  ASSERT_GE((joints.upper - after.position).minCoeff(), 0.0);
  ASSERT_LE((after.velocity.cwiseAbs() - 0.95 * joints.velocity).maxCoeff(), 1e-11);
  ASSERT_LE((after.velocity - before.velocity).cwiseAbs().maxCoeff(), 4.0 * dt + 1e-10);
  ASSERT_LE((after.position - before.position - dt * after.velocity).cwiseAbs().maxCoeff(), 1e-11);
}

}  // namespace prf_control
