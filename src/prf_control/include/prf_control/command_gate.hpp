// SPDX-License-Identifier: BSD-3-Clause
// The last check of every joint command, whatever has computed it and in whatever state. With the
// state (q, v) from which the tick began and the command (q', v'), each joint keeps
//
//   finite numbers
//   q' = q + v' dt
//   |v'| <= velocity                        or |v'| <= |v|: it slows down
//   |v' - v| <= acceleration dt             or, slowing down, braking dt
//   lower <= q' <= upper                    or not farther outside than q
//   |q' - measured| <= max_lag + velocity dt
//
// The last line is what ties the command to the arm: a servo lags behind its command, so the bound
// is the lag that is allowed and one tick's motion. (q, v) is the command of the tick before; where
// the command begins anew, the measured joints at rest.
#pragma once

#include <optional>
#include <string>

#include "prf_control/joint_motion.hpp"

namespace prf_control {

struct GateInput {
  MotionState before;                   // (q, v)
  MotionState wanted;                   // (q', v')
  std::optional<JointVector> measured;  // unwrapped; none: not known at this tick
  double dt = 0.0;                      // [s], > 0; not used where the command begins anew
  bool anew = false;
};

struct GateOutput {
  MotionState command;  // the wanted one, or a safe one in its place
  std::string refusal;  // then: the joint, value and bound
  bool anew = false;    // the safe one is the measured joints at rest
};

// The safe command brakes from `before`; where that is too far from the measured joints, it is the
// measured joints at rest. `max_lag` [rad] > 0.
[[nodiscard]] GateOutput pass_gate(const GateInput& input, const MotionLimits& limits,
                                   double max_lag);

}  // namespace prf_control
