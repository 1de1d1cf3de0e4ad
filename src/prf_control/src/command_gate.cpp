// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/command_gate.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace prf_control {
namespace {

constexpr double kRounding = 1e-9;  // rad, rad/s

struct Refusal {
  const char* what;
  double value;
  double bound;
};

// Each comparison is false for not-a-number, which so is refused.
std::optional<Refusal> refusal_of_motion(const GateInput& input, const MotionLimits& limits,
                                         int i) {
  const double q = input.before.position[i];
  const double v = input.before.velocity[i];
  const double next_q = input.wanted.position[i];
  const double next_v = input.wanted.velocity[i];
  const double dt = input.anew ? 0.0 : input.dt;

  const double step = std::abs(next_q - q - next_v * dt);
  if (!(step <= kRounding)) return Refusal{"position beside velocity [rad]", step, 0.0};
  const double fastest = std::max(limits.velocity[i], std::abs(v));
  if (!(std::abs(next_v) <= fastest + kRounding)) {
    return Refusal{"speed [rad/s]", std::abs(next_v), fastest};
  }
  const double change = std::abs(next_v - v);
  const double slowing = std::min(limits.braking[i] * dt, std::abs(v));
  const bool slows = (next_v - v) * v < 0.0;
  const double most = std::max(limits.acceleration[i] * dt, slows ? slowing : 0.0);
  if (!(change <= most + kRounding)) return Refusal{"change of speed [rad/s]", change, most};
  const double lower = std::min(limits.lower[i], q);
  const double upper = std::max(limits.upper[i], q);
  if (!(next_q >= lower - kRounding)) return Refusal{"position [rad]", next_q, lower};
  if (!(next_q <= upper + kRounding)) return Refusal{"position [rad]", next_q, upper};
  return std::nullopt;
}

std::optional<Refusal> refusal_of_lag(const MotionState& command, const GateInput& input,
                                      const MotionLimits& limits, double max_lag, int i) {
  if (!input.measured) return std::nullopt;
  const double lag = std::abs(command.position[i] - (*input.measured)[i]);
  const double speed = std::max(limits.velocity[i], std::abs(command.velocity[i]));
  const double bound = max_lag + speed * (input.anew ? 0.0 : input.dt);
  if (lag <= bound + kRounding) return std::nullopt;
  return Refusal{"distance from the measured joint [rad]", lag, bound};
}

std::string first_refusal(const GateInput& input, const MotionLimits& limits, double max_lag) {
  for (int i = 0; i < input.wanted.position.size(); ++i) {
    auto refusal = refusal_of_motion(input, limits, i);
    if (!refusal) refusal = refusal_of_lag(input.wanted, input, limits, max_lag, i);
    if (!refusal) continue;
    std::ostringstream text;
    text << "command of joint " << i + 1 << " refused: " << refusal->what << " " << refusal->value
         << ", bound " << refusal->bound;
    return text.str();
  }
  return "";
}

bool is_too_far(const MotionState& command, const GateInput& input, const MotionLimits& limits,
                double max_lag) {
  for (int i = 0; i < command.position.size(); ++i) {
    if (refusal_of_lag(command, input, limits, max_lag, i)) return true;
  }
  return false;
}

}  // namespace

GateOutput pass_gate(const GateInput& input, const MotionLimits& limits, double max_lag) {
  GateOutput output{input.wanted, first_refusal(input, limits, max_lag), false};
  if (output.refusal.empty()) return output;
  output.command = input.before;
  if (!input.anew) output.command = step_to_rest(input.before, input.dt, limits).state;
  if (is_too_far(output.command, input, limits, max_lag)) {
    output.command = at_rest(*input.measured);
    output.anew = true;
  }
  return output;
}

}  // namespace prf_control
