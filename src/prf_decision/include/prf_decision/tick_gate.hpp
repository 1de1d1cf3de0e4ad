// SPDX-License-Identifier: BSD-3-Clause
// Joins control ticks, forecasts, the planner's results and the controller's reports by their
// stamps, so that what is decided at a tick does not depend on the order in which the streams
// arrive (each keeps its own order). On top of prf_core/stream.hpp, the rules of the decision:
//
//   forecast stamped c      is used from the first tick t with t - D >= c
//   tick t                  waits for a forecast while t - D >= newest forecast + P - 5 ms: one
//                           more could be due (5 ms: jitter of the camera's stamps)
//   result for progress a   is used from the tick after that of a, which waits for the result
//   report of tick r        is used from the tick r + C; tick t waits for a report of t - C or
//   later silence                 when the newest tick is more than max_wait ahead of the first one
//                           waiting, the stream is silent and not waited for until it is heard
// with D pipeline_delay, P camera_period and C control_delay. The controller reports on a tick
// after the set-point of that tick, so C > 0. The first report is due C after the first tick.
// Before any forecast, the first tick - P stands for the newest forecast. A forecast of an image
// taken before the first tick is not of this run and is dropped. What is far ahead of the ticks is
// dropped, too: a forecast by more than a second, what follows a tick (result, report) by more than
// 0.1 s, or else its stream's own messages would count as old until its stamp is reached.
#pragma once

#include <arm_kinematics/arm_kinematics.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <prf_core/stream.hpp>
#include <string>
#include <vector>

#include "prf_decision/following_monitor.hpp"
#include "prf_decision/types.hpp"

namespace prf_decision {

struct GateParams {
  Duration pipeline_delay{0};  // D, longest time from an image's exposure to its forecast
  Duration camera_period{0};   // P
  Duration control_delay{0};   // C
  Duration max_wait{0};        // data time after which a stream is silent

  // std::invalid_argument names the parameter, its value and the bound.
  void validate() const;
};

// The planner's result for a progress.
struct PlanResult {
  Stamp stamp{0};                          // of the progress
  std::shared_ptr<const Trajectory> plan;  // null: there is none, see message
  std::string message;
  std::uint32_t demonstration_switch = 0;  // number of the demonstration requested
  bool refused = false;                    // the planner cannot follow that
};

// A predictor's message: null forecast when it was refused on arrival.
struct ForecastArrival {
  Stamp stamp{0};
  std::shared_ptr<const TargetForecast> forecast;
};

struct Tick {
  Stamp stamp{0};
  std::optional<Pose> hand;                                // as measured; none: not known
  std::optional<arm_kinematics::JointVector> joints = {};  // that it was measured by
  std::vector<ForecastArrival> forecasts;                  // used from this tick on, in order
  std::optional<PlanResult> plan_result;                   // used from this tick on, the newest one
  std::optional<ControlReport> control;  // the newest one that may be used, also an earlier one
  bool forecast_silent = false;
  bool planner_silent = false;
  bool control_silent = false;
};

enum class PushResult {
  kAccepted,
  kOld,       // not newer than the one before, or older than the run: dropped
  kFarAhead,  // of the ticks, or a single one far ahead of its own stream: dropped
  kNewRun     // several ticks in a row say that the clock went back: all earlier data is dropped
};

class TickGate {
 public:
  explicit TickGate(const GateParams& params);

  PushResult push_tick(Stamp stamp, const std::optional<Pose>& hand = std::nullopt,
                       const std::optional<arm_kinematics::JointVector>& joints = std::nullopt);
  PushResult push_forecast(ForecastArrival arrival);
  PushResult push_plan_result(PlanResult result);
  PushResult push_control_report(ControlReport report);

  // The next tick that may be processed. When a forecast is used from it on, the tick after it
  // waits for the planner's result with its stamp.
  [[nodiscard]] std::optional<Tick> next();

  // Stamp of the newest tick that was accepted.
  [[nodiscard]] std::optional<Stamp> newest_tick() const { return ticks_.clock().newest(); }

 private:
  static constexpr Duration kClockJump = std::chrono::seconds(1);        // another run, or garbage
  static constexpr Duration kMostLead = std::chrono::milliseconds(100);  // of what follows a tick

  void begin_new_run();
  void begin_at(Stamp first_tick);
  [[nodiscard]] bool is_ahead_by(Duration lead, Stamp stamp) const;
  [[nodiscard]] bool precedes_run(Stamp forecast) const;
  [[nodiscard]] bool forecast_may_be_due(Stamp tick) const;
  [[nodiscard]] bool plan_result_is_due() const;
  [[nodiscard]] bool control_report_is_due(Stamp tick) const;

  GateParams params_;
  // The ticks alone begin a new run.
  struct MeasuredArm {
    std::optional<Pose> hand;
    std::optional<arm_kinematics::JointVector> joints;
  };
  prf_core::StampedQueue<MeasuredArm> ticks_;
  prf_core::StampedQueue<ForecastArrival> forecasts_{{Duration::max(), kClockJump}};
  prf_core::StampedQueue<PlanResult> plan_results_{{Duration::max(), Duration::max()}};
  prf_core::StampedQueue<ControlReport> control_reports_{{Duration::max(), Duration::max()}};
  prf_core::SilenceMonitor forecast_silence_;
  prf_core::SilenceMonitor plan_silence_;
  prf_core::SilenceMonitor control_silence_;
  std::optional<Stamp> first_tick_;
  std::optional<Stamp> awaited_plan_result_;
  std::optional<ControlReport> control_;  // the newest one used
};

}  // namespace prf_decision
