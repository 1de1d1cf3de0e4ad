// SPDX-License-Identifier: BSD-3-Clause
#include "prf_drivers/operator_gate.hpp"

#include <prf_core/require.hpp>

namespace prf_drivers {

void OperatorParams::validate() const {
  prf_core::require_between("enable_timeout", enable_timeout, 0.02, 2.0, "s");
}

OperatorGate::OperatorGate(const OperatorParams& params) : params_(params) { params_.validate(); }

void OperatorGate::enable(bool pressed, double now) {
  pressed_ = pressed ? std::optional(now) : std::nullopt;
}

std::string OperatorGate::veto(double now) const {
  if (stopped_) return "stopped, until the service ~reset is called";
  if (params_.needs_check && !red_)
    return "the bring-up check has not been made: start check_robot announce:=true";
  if (params_.needs_check && !red_->empty()) return "the bring-up check found: " + *red_;
  if (hold_) return "the operator holds, until the service ~hold is called with false";
  if (!params_.dead_man) return "";
  // A clock that is not a number does not let the arm move.
  const bool fresh = pressed_ && now - *pressed_ <= params_.enable_timeout;
  return fresh ? "" : "the dead-man's switch is not pressed";
}

}  // namespace prf_drivers
