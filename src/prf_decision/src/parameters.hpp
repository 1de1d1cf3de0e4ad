// SPDX-License-Identifier: BSD-3-Clause
// Private: the node's parameters from its private namespace.
#pragma once

#include <prf_parameters/private_parameters.hpp>
#include <stdexcept>
#include <string>

#include "prf_decision/decision.hpp"
#include "prf_decision/hmm_file.hpp"
#include "prf_decision/tick_gate.hpp"

namespace prf_decision {

struct NodeParameters {
  GateParameters gate;
  DecisionParameters decision;
  std::string demonstration;  // that the planner has; empty: not known
};

// Bounded before it becomes whole nanoseconds, which cannot hold NaN or infinity.
inline Duration checked_seconds(const std::string& name, double value) {
  constexpr double kLongest = 1e6;  // s
  if (!(std::abs(value) <= kLongest)) {
    throw std::invalid_argument(name + " is " + std::to_string(value) +
                                ", must be finite and at most 1e6 s");
  }
  return from_seconds(value);
}

// An exception names the parameter or the HMM file, its value and the bound.
inline NodeParameters load_parameters(prf_parameters::PrivateParameters values) {
  const auto seconds = [&](const char* key) { return checked_seconds(key, values.number(key)); };
  NodeParameters parameters;
  GateParameters& gate = parameters.gate;
  gate.pipeline_delay = seconds("pipeline_delay");
  gate.camera_period = seconds("camera_period");
  gate.max_wait = seconds("max_wait");

  DecisionParameters& decision = parameters.decision;
  decision.framework = values.flag("framework");
  decision.autostart = values.flag("autostart");
  parameters.demonstration = values.text("demonstration");
  decision.max_gap = gate.max_wait;
  decision.lead = seconds("lead");
  decision.hold_time = seconds("hold_time");
  decision.dwell_time = seconds("dwell_time");
  decision.time_limit = seconds("time_limit");
  decision.tracking_tolerance = values.number("tracking_tolerance");
  const auto speed = values.numbers("catch_up_speed", 2);
  decision.catch_up = {speed[0], speed[1], values.number("catch_up_time")};

  GuardParameters& guards = decision.guards;
  const auto coast = values.numbers("coast_limits", 3);
  guards.pause_after = checked_seconds("coast_limits[0]", coast[0]);
  guards.reverse_after = checked_seconds("coast_limits[1]", coast[1]);
  guards.stop_after = checked_seconds("coast_limits[2]", coast[2]);
  guards.max_reach = values.number("max_reach");
  guards.workspace_radius = values.number("workspace_radius");
  guards.max_target_speed = values.number("max_target_speed");

  const std::string hmm_file = values.text("hmm_file");
  values.refuse_unknown();
  decision.hmm = load_hmm(hmm_file);
  gate.validate();
  decision.validate();
  return parameters;
}

}  // namespace prf_decision
