// SPDX-License-Identifier: BSD-3-Clause
// Private: the node's parameters from its private namespace.
#pragma once

#include <prf_ros/private_parameters.hpp>
#include <prf_ros/reconfigurable.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "prf_decision/decision.hpp"
#include "prf_decision/hmm_file.hpp"
#include "prf_decision/tick_gate.hpp"

namespace prf_decision {

struct NodeParameters {
  GateParameters gate;
  DecisionParameters decision;
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
inline NodeParameters load_parameters(prf_ros::PrivateParameters values) {
  const auto seconds = [&](const char* key) { return checked_seconds(key, values.number(key)); };
  NodeParameters parameters;
  GateParameters& gate = parameters.gate;
  gate.pipeline_delay = seconds("pipeline_delay");
  gate.camera_period = seconds("camera_period");
  gate.max_wait = seconds("max_wait");

  DecisionParameters& decision = parameters.decision;
  decision.framework = values.flag("framework");
  decision.autostart = values.flag("autostart");
  decision.max_gap = gate.max_wait;
  decision.lead = seconds("lead");
  decision.hold_time = seconds("hold_time");
  decision.dwell_time = seconds("dwell_time");
  decision.time_limit = seconds("time_limit");
  decision.tracking_tolerance = values.number("tracking_tolerance");
  decision.approach_length = values.number("approach_length");
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

// What a person may tune while the node runs.
inline std::vector<prf_ros::ReconfigurableParams::Number> live_numbers(
    const DecisionParameters& decision) {
  return {{"dwell_time", to_seconds(decision.dwell_time), "s, least time in a state for the HMM"},
          {"hold_time", to_seconds(decision.hold_time), "s, to follow until done; next execution"},
          {"lead", to_seconds(decision.lead), "s, the followed goal is so much after the tick"},
          {"catch_up_time", decision.catch_up.time_constant, "s, with which a small gap closes"},
          {"tracking_tolerance", decision.tracking_tolerance, "m, that counts as following"},
          {"max_target_speed", decision.guards.max_target_speed, "m/s, faster ones are refused"}};
}

inline DecisionParameters with_live_numbers(const DecisionParameters& decision,
                                            const prf_ros::ReconfigurableParams::Values& values) {
  DecisionParameters tuned = decision;
  tuned.dwell_time = checked_seconds("dwell_time", values.at("dwell_time"));
  tuned.hold_time = checked_seconds("hold_time", values.at("hold_time"));
  tuned.lead = checked_seconds("lead", values.at("lead"));
  tuned.catch_up.time_constant = values.at("catch_up_time");
  tuned.tracking_tolerance = values.at("tracking_tolerance");
  tuned.guards.max_target_speed = values.at("max_target_speed");
  return tuned;
}

}  // namespace prf_decision
