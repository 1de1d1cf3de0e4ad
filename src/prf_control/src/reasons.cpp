// SPDX-License-Identifier: BSD-3-Clause
#include "reasons.hpp"

#include <sstream>

namespace prf_control {

const std::string& Reasons::name(int joint) const {
  return joints[static_cast<std::size_t>(joint)];
}

std::string Reasons::leap(double gap, double bound) const {
  std::ostringstream text;
  text << "joint_states jumped forward by " << gap << " s, bound " << bound << " s";
  return text.str();
}

std::string Reasons::lag(int joint, double lag, double bound) const {
  std::ostringstream text;
  text << name(joint) << " is " << lag << " rad from its command, bound " << bound << " rad";
  return text.str();
}

std::string Reasons::outside(const JointVector& position, int joint) const {
  std::ostringstream text;
  text << name(joint) << " at " << position[joint] << " rad is outside its limits ["
       << limits.lower[joint] << ", " << limits.upper[joint] << "] rad";
  return text.str();
}

std::string Reasons::turns(const JointVector& reported, const JointVector& taken) const {
  std::ostringstream text;
  for (int i = 0; i < reported.size(); ++i) {
    if (reported[i] == taken[i]) continue;
    text << "; " << name(i) << " is reported as " << reported[i] << " rad, which is " << taken[i]
         << " rad in the turn of its commands";
  }
  return text.str();
}

std::string Reasons::step(const FollowerStep& step, double max_joint_step) const {
  std::ostringstream text;
  if (step.goal == GoalKind::kNearest) {
    text << "no joint position within limits gives the pose; goes to the nearest, now "
         << step.position_deviation << " m and " << step.orientation_deviation << " rad from it";
  } else if (step.goal == GoalKind::kJumpRefused) {
    text << name(step.jump_joint) << " would jump by " << step.jump << " rad, bound "
         << max_joint_step << " rad; creeps toward the pose";
  } else if (step.goal == GoalKind::kChangesBranch) {
    text << "changes branch slowly, " << name(step.jump_joint) << " has " << step.jump
         << " rad to go";
  } else if (step.goal == GoalKind::kInside) {
    text << "goes back inside the joint limits slowly, " << name(step.jump_joint) << " has "
         << step.jump << " rad to go";
  } else {
    const bool position = step.motion.limit == Limit::kPosition;
    text << name(step.motion.joint) << (position ? " near its position limit, " : " ") << "asked "
         << step.motion.asked << " rad/s, bound " << step.motion.bound << " rad/s";
  }
  return text.str();
}

}  // namespace prf_control
