// SPDX-License-Identifier: BSD-3-Clause
#include "prf_control/tick_joiner.hpp"

#include <cmath>
#include <stdexcept>

namespace prf_control {
namespace {

// Set-points kept for ticks that have not come; 10 s at 100 Hz.
constexpr std::size_t kMaxSetpoints = 1000;

}  // namespace

TickJoiner::TickJoiner(double max_wait) {
  if (!(std::isfinite(max_wait) && max_wait > 0.0 && max_wait <= 10.0)) {
    throw std::invalid_argument("max_wait = " + std::to_string(max_wait) +
                                " s, must be > 0 and <= 10");
  }
  max_wait_ns_ = std::llround(max_wait * 1e9);
}

void TickJoiner::add_joints(const JointSample& joints) {
  if (newest_tick_ && joints.stamp_ns == *newest_tick_) {
    ++counts_.duplicate_ticks;
    return;
  }
  const bool new_run = newest_tick_ && joints.stamp_ns < *newest_tick_;
  if (new_run) begin_new_run();
  newest_tick_ = joints.stamp_ns;
  ticks_.push_back({joints, std::nullopt, new_run});
}

void TickJoiner::begin_new_run() {
  ++counts_.new_runs;
  ticks_.clear();
  answered_.reset();
  silent_ = false;
  if (!setpoints_restarted_) {
    setpoints_.clear();
    newest_setpoint_.reset();
  }
  setpoints_restarted_ = false;
}

void TickJoiner::add_setpoint(std::int64_t stamp_ns, const Setpoint& setpoint) {
  silent_ = false;
  if (newest_setpoint_ && stamp_ns < *newest_setpoint_) {
    setpoints_.clear();
    setpoints_restarted_ = newest_tick_ && stamp_ns < *newest_tick_;
  }
  newest_setpoint_ = stamp_ns;
  if (answered_ && stamp_ns <= *answered_ && !setpoints_restarted_) {
    ++counts_.late_setpoints;
    return;
  }
  if (!setpoints_.emplace(stamp_ns, setpoint).second) ++counts_.late_setpoints;
  if (setpoints_.size() > kMaxSetpoints) setpoints_.erase(setpoints_.begin());
}

bool TickJoiner::waits(std::int64_t stamp_ns) {
  if (silent_ || (newest_setpoint_ && *newest_setpoint_ > stamp_ns)) return false;
  if (*newest_tick_ - stamp_ns <= max_wait_ns_) return true;
  silent_ = true;
  ++counts_.silences;
  return false;
}

std::optional<JoinedTick> TickJoiner::next() {
  if (ticks_.empty()) return std::nullopt;
  JoinedTick tick = ticks_.front();
  const std::int64_t stamp_ns = tick.joints.stamp_ns;
  const auto found = setpoints_.find(stamp_ns);
  if (found != setpoints_.end()) {
    tick.setpoint = found->second;
    setpoints_.erase(setpoints_.begin(), std::next(found));
    setpoints_restarted_ = false;
  } else if (waits(stamp_ns)) {
    return std::nullopt;
  } else {
    ++counts_.missing_setpoints;
  }
  ticks_.pop_front();
  answered_ = stamp_ns;
  return tick;
}

}  // namespace prf_control
