// SPDX-License-Identifier: BSD-3-Clause
// What the controller says about a tick, with joint, value and bound. Private to the library.
#pragma once

#include <string>
#include <vector>

#include "prf_control/setpoint_follower.hpp"

namespace prf_control {

struct Reasons {
  const std::vector<std::string>& joints;
  const arm_kinematics::JointLimits& limits;

  [[nodiscard]] std::string leap(double gap, double bound) const;
  [[nodiscard]] std::string lag(int joint, double lag, double bound) const;
  [[nodiscard]] std::string outside(const JointVector& position, int joint) const;
  // Of the joints that were taken in another turn; empty: none.
  [[nodiscard]] std::string turns(const JointVector& reported, const JointVector& taken) const;
  [[nodiscard]] std::string step(const FollowerStep& step, double max_joint_step) const;

 private:
  [[nodiscard]] const std::string& name(int joint) const;
};

}  // namespace prf_control
