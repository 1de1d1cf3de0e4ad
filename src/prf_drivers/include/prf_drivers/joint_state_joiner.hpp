// SPDX-License-Identifier: BSD-3-Clause
// Joins the joint states of several senders (arm, legs, gripper), each with a rate of its own, into
// the control ticks: one sample with all joints, at the controller's period.
//
// The first source leads: its stamps are the clock. A tick has the lead's joints and, of every
// other source, the newest sample that is at least `settle` older than the tick, so that the result
// does not depend on which of two messages of one instant arrives first. A source that has no
// sample of the last `max_age` is left out; its joints are then not in the tick.
//
//   lead as fast as the period  -> a tick for each of its samples, with its stamp
//   faster                      -> of its samples, those on the grid of the period
//   slower                      -> tick_at() between them: its joints go on with their velocity,
//                                  for max_age at most
//
// A joint that two sources name is taken from the first one.
#pragma once

#include <cstddef>
#include <optional>
#include <prf_core/clock_monitor.hpp>
#include <prf_core/time.hpp>
#include <string>
#include <vector>

namespace prf_drivers {

// All vectors are as long as `names`.
struct JointSample {
  prf_core::Stamp stamp{0};
  std::vector<std::string> names;
  std::vector<double> positions;   // rad
  std::vector<double> velocities;  // rad/s
  std::vector<double> efforts;     // Nm
};

struct JointJoinerParams {
  std::size_t sources = 0;  // 1 to 16; the first one leads
  double period = 0.0;      // s, of the ticks, 0.001 to 0.1
  double settle = 0.0;      // s, 0 to 1
  double max_age = 0.0;     // s, 0.01 to 2

  // Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

class JointStateJoiner {
 public:
  explicit JointStateJoiner(const JointJoinerParams& params);

  // A sample of source `source`. Returns the tick that it gives; only samples of the lead give one.
  // `refusal` says why the sample is dropped; empty: it was taken. Throws std::invalid_argument for
  // a source that there is not.
  struct Added {
    std::optional<JointSample> tick;
    std::string refusal;
  };
  Added add(std::size_t source, const JointSample& sample);

  // The tick at `now`, for a lead that is slower than the period; none: no sample of the lead of
  // the last max_age, or a tick of this stamp or a later one has been given.
  std::optional<JointSample> tick_at(prf_core::Stamp now);

 private:
  struct Source {
    prf_core::ClockMonitor clock;
    std::vector<JointSample> samples;  // of the last settle, and one before; rising
  };

  [[nodiscard]] bool is_due(prf_core::Stamp stamp, prf_core::StampOrder order);
  [[nodiscard]] JointSample joined(JointSample tick) const;
  void forget(Source& source) const;

  JointJoinerParams params_;
  std::vector<Source> sources_;
  std::optional<prf_core::Stamp> due_;     // of the next tick
  std::optional<prf_core::Stamp> given_;   // newest tick
  std::optional<prf_core::Stamp> filled_;  // newest tick between messages
};

}  // namespace prf_drivers
