// SPDX-License-Identifier: BSD-3-Clause
// Streams for a tick gate.
#pragma once

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>

#include "prf_decision/tick_gate.hpp"
#include "scenario.hpp"

namespace prf_decision {

using std::chrono::milliseconds;

inline const GateParams kGate{milliseconds(60), from_seconds(1 / 30.0), milliseconds(50),
                              milliseconds(300)};

inline ForecastArrival forecast(Stamp stamp) { return {stamp, std::make_shared<TargetForecast>()}; }

inline ControlReport report(Stamp stamp) { return {stamp, false, ""}; }

inline PlanResult plan_result(Stamp stamp) { return {stamp, std::make_shared<Trajectory>(), ""}; }

// Line per tick: its stamp, the forecasts and the plan result used from it on, what is silent.
inline std::string describe(const Tick& tick) {
  std::ostringstream line;
  line << tick.stamp.count() << ":";
  for (const auto& arrival : tick.forecasts) line << " f" << arrival.stamp.count();
  if (tick.plan_result) line << " a" << tick.plan_result->stamp.count();
  if (tick.forecast_silent) line << " forecast_silent";
  if (tick.planner_silent) line << " planner_silent";
  if (tick.control_silent) line << " control_silent";
  return line.str() + "\n";
}

// Processes what can be, with a controller that reports on every tick.
inline std::string process(TickGate& gate) {
  std::string processed;
  while (const auto tick = gate.next()) {
    processed += describe(*tick);
    gate.push_control_report(report(tick->stamp));
  }
  return processed;
}

// Pushes ticks 0 .. count-1 and gives back what was processed.
inline std::string tick_through(TickGate& gate, int from, int to) {
  std::string processed;
  for (int i = from; i < to; ++i) {
    gate.push_tick(i * kTickPeriod);
    processed += process(gate);
  }
  return processed;
}

inline std::ptrdiff_t lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

}  // namespace prf_decision
