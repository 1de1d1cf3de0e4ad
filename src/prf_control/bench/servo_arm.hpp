// SPDX-License-Identifier: BSD-3-Clause
// A stand-in for the arm, for measurements without simulator: each joint follows
// v + gain (q_command - q) through a first-order lag, after a dead time of one period, as a servo
// drive does.
#pragma once

#include <cmath>

#include "prf_control/joint_motion.hpp"

namespace prf_control {

struct ServoArm {
  static constexpr double kGain = 20.0;    // 1/s
  static constexpr double kLag = 0.01;     // s
  static constexpr double kPeriod = 0.01;  // s

  JointVector position;
  JointVector velocity = JointVector::Zero(position.size());
  MotionState pending{position,
                      JointVector::Zero(position.size())};  // the command of one period ago

  // One period with a new command.
  void run(const MotionState& command) {
    constexpr int kSteps = 10;
    constexpr double kStep = kPeriod / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const JointVector wanted = pending.velocity + kGain * (pending.position - position);
      velocity += (wanted - velocity) * -std::expm1(-kStep / kLag);
      position += kStep * velocity;
    }
    pending = command;
  }
};

}  // namespace prf_control
