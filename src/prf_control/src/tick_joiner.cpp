// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/tick_joiner.hpp"

namespace prf_control {

using prf_core::StampOrder;

TickJoiner::TickJoiner(prf_core::Duration max_wait) : joiner_({max_wait}) {}

void TickJoiner::add_joints(const JointSample& joints) {
  const StampOrder order = joiner_.advance(joints.stamp);
  if (order == StampOrder::kDuplicate) ++counts_.duplicate_ticks;
  if (order == StampOrder::kOld) ++counts_.old_ticks;
  if (order == StampOrder::kFarAhead) ++counts_.far_ahead_ticks;
  if (!prf_core::is_accepted(order)) return;
  if (order == StampOrder::kBackwardJump) ++counts_.new_runs;
  joiner_.push_primary(joints.stamp, joints);
}

void TickJoiner::add_setpoint(prf_core::Stamp stamp, const Setpoint& setpoint) {
  const StampOrder order = joiner_.push_secondary(stamp, setpoint);
  if (order == StampOrder::kDuplicate || order == StampOrder::kOld) ++counts_.late_setpoints;
  if (order == StampOrder::kFarAhead) ++counts_.far_ahead_setpoints;
}

std::optional<TickJoiner::Joined> TickJoiner::next() {
  const bool was_silent = joiner_.is_silent();
  auto joined = joiner_.pop();
  if (joiner_.is_silent() && !was_silent) ++counts_.silences;
  if (joined && !joined->secondary) ++counts_.missing_setpoints;
  return joined;
}

}  // namespace prf_control
