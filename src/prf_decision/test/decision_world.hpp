// SPDX-License-Identifier: BSD-3-Clause
// A world that plays ticks, forecasts and plans to a decision, and checks that its set-point never
// jumps.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "scenario.hpp"

namespace prf_decision {

inline const Eigen::Vector3d kTarget(1.0, 0, 0.5);  // puts the hand where the straight skill ends
inline const Eigen::Vector3d kStill(0, 0, 0);

// Ticks at 100 Hz; every third one brings a forecast of the target as it then is, and the tick
// after it the same plan again.
class World {
 public:
  explicit World(const DecisionParams& parameters = usual_params()) : decision_(parameters) {}

  Outcome tick() {
    Tick tick;
    tick.stamp = now_;
    tick.hand = hand;
    tick.forecast_stale = forecast_stale;
    tick.plan_stale = plan_stale;
    if (count_ % 3 == 0 && !forecast_stale) {
      auto seen = std::make_shared<TargetForecast>(
          forecast_of(now_ - from_seconds(0.06), position, velocity, status));
      if (status != TargetStatus::kTracking) seen->since_measurement = seen->stamp - last_seen_;
      if (status == TargetStatus::kNoTarget) seen->predictions.clear();
      if (status == TargetStatus::kTracking) last_seen_ = seen->stamp;
      tick.forecasts.push_back({seen->stamp, seen});
    }
    if (count_ % 3 == 1 && answers && !plan_stale) {
      tick.answer = answer();
    }
    ++count_;
    now_ += kTickPeriod;
    const Outcome outcome = decision_.update(tick);
    wanted_ = outcome.progress.demonstration;
    check_continuity(outcome);
    return outcome;
  }

  // Ticks until the state is reached; the outcome of the last tick.
  Outcome until(State state, double seconds) {
    Outcome outcome = tick();
    for (const Stamp end = now_ + from_seconds(seconds); outcome.progress.state != state;) {
      if (now_ > end) {
        ADD_FAILURE() << "still " << name(outcome.progress.state) << ", not " << name(state) << ": "
                      << outcome.progress.reason;
        break;
      }
      outcome = tick();
    }
    return outcome;
  }

  Outcome run(double seconds) {
    Outcome outcome;
    for (const Stamp end = now_ + from_seconds(seconds); now_ < end;) outcome = tick();
    return outcome;
  }

  Decision& decision() { return decision_; }
  void forget_setpoint() { setpoint_.reset(); }  // the arm was moved meanwhile
  void leap(double seconds) { now_ += from_seconds(seconds); }

  std::optional<Pose> hand;  // measured
  Eigen::Vector3d position = kTarget;
  Eigen::Vector3d velocity = kStill;
  TargetStatus status = TargetStatus::kTracking;
  bool forecast_stale = false;
  bool plan_stale = false;
  bool answers = true;
  std::shared_ptr<const Trajectory> plan = std::make_shared<Trajectory>(straight_skill());
  std::map<std::string, std::shared_ptr<const Trajectory>> others;  // by demonstration

 private:
  PlanAnswer answer() const {
    PlanAnswer result{now_ - kTickPeriod, plan, plan ? "" : "no solution", wanted_.number, false};
    if (wanted_.name.empty()) return result;
    const auto found = others.find(wanted_.name);
    result.refused = found == others.end();
    result.plan = result.refused ? nullptr : found->second;
    if (!result.plan) result.message = result.refused ? "no such file" : "no solution";
    return result;
  }

  void check_continuity(const Outcome& outcome) {
    if (!outcome.setpoint) return;
    const Eigen::Vector3d& at = outcome.setpoint->pose.position;
    // The skill runs at 0.3 m/s, on the approach across the target's motion; the gap closes at
    // 0.2 m/s on top of it.
    const double fastest = std::hypot(0.3 * 1.2, velocity.norm()) + 0.2;
    if (setpoint_) {
      EXPECT_LT((at - *setpoint_).norm(), fastest * to_seconds(kTickPeriod) + 1e-9);
    }
    setpoint_ = at;
  }

  Decision decision_;
  Stamp now_ = std::chrono::seconds(50);
  Stamp last_seen_{0};
  int count_ = 0;
  NamedDemonstration wanted_;
  std::optional<Eigen::Vector3d> setpoint_;
};

}  // namespace prf_decision
