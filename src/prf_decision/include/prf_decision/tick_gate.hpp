// SPDX-License-Identifier: BSD-3-Clause
// Joins ticks, forecasts and plans by their stamps, so that what is decided at a tick does not
// depend on the order in which the three streams arrive (each keeps its own order).
//
//   forecast stamped c      is in force from the first tick t with t - D >= c
//   tick t waits for it     while t - D >= newest forecast + P - margin: one more could be due
//   answer to progress a    is in force from the next tick, which waits for it
//   give-up                 when the newest tick is more than max_wait ahead of the first one
//                           waiting, the silent stream is stale: not waited for until it speaks
// with D pipeline_delay and P camera_period. Before any forecast, "newest" is the first tick - P;
// a forecast of an image taken before the first tick is not of this run and is dropped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "prf_decision/types.hpp"

namespace prf_decision {

struct GateParams {
  Duration pipeline_delay{0};  // D, exposure of an image to its forecast, at most
  Duration camera_period{0};   // P
  Duration max_wait{0};        // data time after which a silent stream is stale

  void validate() const;
};

// A planner's answer: null plan with the reason when there is none.
struct PlanAnswer {
  Stamp stamp{0};  // of the progress answered
  std::shared_ptr<const Trajectory> plan;
  std::string message;
  std::uint32_t demonstration_switch = 0;  // number of the demonstration that was wanted
  bool refused = false;                    // that one cannot be followed
};

// A predictor's message: null forecast when it was refused on arrival.
struct ForecastArrival {
  Stamp stamp{0};
  std::shared_ptr<const TargetForecast> forecast;
};

struct Tick {
  Stamp stamp{0};
  std::optional<Pose> hand;                // as measured; none: not known
  std::vector<ForecastArrival> forecasts;  // that come into force at this tick, in order
  std::optional<PlanAnswer> answer;        // that comes into force at this tick, the newest one
  bool forecast_stale = false;
  bool plan_stale = false;
};

enum class Push {
  kTaken,
  kOld,     // not newer than the one before, or older than the run: dropped
  kFuture,  // more than a second ahead of the ticks: dropped
  kNewRun   // the data's clock went back: everything before it is forgotten
};

class TickGate {
 public:
  explicit TickGate(const GateParams& parameters);

  Push push_tick(Stamp stamp, const std::optional<Pose>& hand = std::nullopt);
  Push push_forecast(ForecastArrival arrival);
  Push push_answer(PlanAnswer answer);

  // The next tick that may be processed. When it brings a forecast into force, the tick after it
  // waits for the answer with its stamp.
  [[nodiscard]] std::optional<Tick> next();

 private:
  void begin_new_run();
  void begin_at(Stamp first_tick);
  [[nodiscard]] bool precedes_run(Stamp forecast) const;
  [[nodiscard]] bool forecast_may_be_due(Stamp tick) const;
  [[nodiscard]] bool answer_is_due() const;

  GateParams parameters_;
  struct JointTick {
    Stamp stamp;
    std::optional<Pose> hand;
  };

  std::deque<JointTick> ticks_;
  std::deque<ForecastArrival> forecasts_;
  std::deque<PlanAnswer> answers_;
  std::optional<Stamp> newest_tick_;
  std::optional<Stamp> first_tick_;
  std::optional<Stamp> newest_forecast_;
  std::optional<Stamp> newest_answer_;
  std::optional<Stamp> awaited_answer_;
  bool forecast_stale_ = false;
  bool plan_stale_ = false;
};

}  // namespace prf_decision
