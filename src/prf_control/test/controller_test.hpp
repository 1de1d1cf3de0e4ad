// SPDX-License-Identifier: BSD-3-Clause
// What the tests of ArmController share: parameters, ticks, set-points.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "follower_limits.hpp"
#include "prf_control/arm_controller.hpp"

namespace prf_control {

inline constexpr prf_core::Duration kTick = std::chrono::milliseconds(10);

inline ArmControllerParams controller_params() {
  return {params(),
          0.2,
          0.3,
          {"joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6", "joint_7"}};
}

inline JointSample joints_at(std::int64_t tick, const JointVector& q = home()) {
  return {tick * kTick, q, ""};
}

inline JointSample faulty_joints_at(std::int64_t tick) {
  return {tick * kTick, std::nullopt, "joint_3 bad"};
}

inline Setpoint pose_setpoint(const Eigen::Isometry3d& pose) {
  Setpoint setpoint;
  setpoint.kind = SetpointKind::kPose;
  setpoint.pose.hand_in_base = pose;
  return setpoint;
}

inline Setpoint beside_home(double offset) {
  Eigen::Isometry3d pose = jaco_kinematics::forward(home());
  pose.translation().y() += offset;
  return pose_setpoint(pose);
}

// The results that a tick and its set-point bring.
inline std::vector<ControlResult> answers(ArmController& controller, const JointSample& joints,
                                          const Setpoint& setpoint) {
  auto results = controller.add_joints(joints);
  for (const ControlResult& more : controller.add_setpoint(joints.stamp, setpoint)) {
    results.push_back(more);
  }
  return results;
}

// The result of one tick and its set-point.
inline ControlResult ask(ArmController& controller, const JointSample& joints,
                         const Setpoint& setpoint) {
  const auto results = answers(controller, joints, setpoint);
  EXPECT_EQ(results.size(), 1u);
  return results.empty() ? ControlResult() : results.front();
}

}  // namespace prf_control
