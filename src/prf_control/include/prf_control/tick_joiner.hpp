// SPDX-License-Identifier: BSD-3-Clause
// Joins each tick (a joint_states message) with the set-point of the same stamp.
//
// The two topics interleave at random, each in its own order. A tick waits for its set-point:
//   a set-point with this stamp has come                      -> joined
//   a later one has come                                      -> none, it was never published
//   a tick more than max_wait later has come                  -> none, and no more waiting
//                                                                until a set-point comes again
// so the answers do not depend on the interleaving as long as neither topic lags by max_wait.
// Ticks that go back in time begin a new run; what was still waiting is dropped.
#pragma once

#include <cstdint>
#include <deque>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <map>
#include <optional>
#include <string>

#include "prf_control/setpoint.hpp"

namespace prf_control {

struct JointSample {
  std::int64_t stamp_ns = 0;
  std::optional<JointVector> position;  // [rad], none when a value was not finite
  std::string fault;                    // then: which
};

struct JoinedTick {
  JointSample joints;
  std::optional<Setpoint> setpoint;  // none: it did not come
  bool new_run = false;              // the first of a run that began by going back in time
};

struct JoinerCounts {
  std::uint64_t duplicate_ticks = 0;
  std::uint64_t new_runs = 0;
  std::uint64_t late_setpoints = 0;     // came after their tick had been answered, or twice
  std::uint64_t missing_setpoints = 0;  // ticks answered without
  std::uint64_t silences = 0;           // times that waiting was given up
};

class TickJoiner {
 public:
  explicit TickJoiner(double max_wait);  // [s], > 0

  void add_joints(const JointSample& joints);
  void add_setpoint(std::int64_t stamp_ns, const Setpoint& setpoint);
  // The next tick whose answer is decided, oldest first.
  std::optional<JoinedTick> next();

  [[nodiscard]] const JoinerCounts& counts() const { return counts_; }

 private:
  void begin_new_run();
  [[nodiscard]] bool waits(std::int64_t stamp_ns);

  std::int64_t max_wait_ns_;
  std::deque<JoinedTick> ticks_;
  std::map<std::int64_t, Setpoint> setpoints_;
  std::optional<std::int64_t> newest_tick_;
  std::optional<std::int64_t> newest_setpoint_;
  std::optional<std::int64_t> answered_;
  bool silent_ = false;               // waiting was given up
  bool setpoints_restarted_ = false;  // the set-points went back in time, the ticks not yet
  JoinerCounts counts_;
};

}  // namespace prf_control
