// SPDX-License-Identifier: BSD-3-Clause
// The joint positions that a driver reports, checked, and in the turns in which the arm is
// commanded.
//
// A driver may report an angle in any turn: -1.0 rad is 5.283 rad. Joints with limits are taken in
// the turn that lies within them, or nearest to them. The continuous joints count: they are
// taken as reported, and the commands are in the turn that is reported. So a driver has to take
// positions in the turn in which it reports them, or modulo a turn. One that begins another count
// takes the commands with it, and the joint does not turn.
#pragma once

#include <arm_kinematics/arm_kinematics.hpp>
#include <optional>
#include <prf_core/time.hpp>
#include <string>
#include <vector>

namespace prf_control {

using arm_kinematics::JointLimits;
using arm_kinematics::JointVector;

// [rad] 160 turns, more than any joint winds up. Larger angles are no measurement.
inline constexpr double kLargestAngle = 1e3;

// One control tick.
struct JointSample {
  prf_core::Stamp stamp{0};
  std::optional<JointVector> position;  // [rad], none when one is not finite or too large
  std::string fault;                    // then: which
};

// `names` of the arm's joints, for the fault.
[[nodiscard]] JointSample checked_joints(prf_core::Stamp stamp, const JointVector& position,
                                         const std::vector<std::string>& names);

[[nodiscard]] JointVector unwrapped(const JointVector& reported, const JointLimits& limits);

// The whole turns by which the continuous joints of a command are to be moved [rad] so that it is
// within half a turn of the measured joints. 0 for the others.
[[nodiscard]] JointVector turns_between(const JointVector& command, const JointVector& measured,
                                        const JointLimits& limits);

// How far each joint is outside its position limits, 0 inside [rad].
[[nodiscard]] JointVector joints_outside(const JointVector& position, const JointLimits& limits);

}  // namespace prf_control
