// SPDX-License-Identifier: BSD-3-Clause
// The joint positions that a driver reports, checked, and in the turns in which the arm is
// commanded.
//
// A driver may report an angle in any turn: -1.0 rad is 5.283 rad. Joints 2, 4 and 6 are taken in
// the turn that lies within their limits, or nearest to them. The continuous joints count: they are
// taken as reported, and the commands are in the turn that is reported. So a driver has to take
// positions in the turn in which it reports them, or modulo a turn. One that begins another count
// takes the commands with it, and the joint does not turn.
#pragma once

#include <jaco_kinematics/jaco_kinematics.hpp>
#include <optional>
#include <prf_core/time.hpp>
#include <string>
#include <vector>

namespace prf_control {

using jaco_kinematics::JointVector;

// [rad] 160 turns, more than any joint winds up. Larger angles are no measurement.
inline constexpr double kLargestAngle = 1e3;

// One control tick.
struct JointSample {
  prf_core::Stamp stamp{0};
  std::optional<JointVector> position;  // [rad], none when one is not finite or too large
  std::string fault;                    // then: which
};

// `names` of the seven joints, for the fault.
[[nodiscard]] JointSample checked_joints(prf_core::Stamp stamp, const JointVector& position,
                                         const std::vector<std::string>& names);

[[nodiscard]] JointVector unwrapped(const JointVector& reported);

// The whole turns by which the continuous joints of a command are to be moved [rad] so that it is
// within half a turn of the measured joints. 0 for the others.
[[nodiscard]] JointVector turns_between(const JointVector& command, const JointVector& measured);

// How far each joint is outside its position limits, 0 inside [rad].
[[nodiscard]] JointVector joints_outside(const JointVector& position);

}  // namespace prf_control
