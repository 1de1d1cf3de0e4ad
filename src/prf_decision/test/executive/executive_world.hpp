// SPDX-License-Identifier: BSD-3-Clause
// A world that plays ticks, forecasts and plans to a skill executive, and checks that its set-point
// never jumps.
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
// after it the same plan again. The hand is where the last set-point was, unless the arm is
// blocked.
class World {
 public:
  explicit World(const DecisionParams& parameters = usual_params()) : executive_(parameters) {}

  ExecutiveResult tick() {
    Tick tick;
    tick.stamp = now_;
    if (hand_known) tick.hand = hand;
    tick.control = ControlReport{now_ - from_seconds(0.05), control_fails, "joint 3 unknown"};
    tick.control_silent = control_silent;
    tick.forecast_silent = forecast_silent;
    tick.planner_silent = planner_silent;
    if (count_ % 3 == 0 && !forecast_silent) {
      auto forecast = std::make_shared<TargetForecast>(
          forecast_of(now_ - from_seconds(0.06), position, velocity, status));
      if (status != TargetStatus::kTracking)
        forecast->since_measurement = forecast->stamp - last_measured_;
      forecast->measured_motion.velocity = velocity + Eigen::Vector3d(0, 0, measured_off);
      forecast->measured_motion.velocity_covariance = 1e-6 * Eigen::Matrix3d::Identity();
      if (status == TargetStatus::kNoTarget) forecast->predictions.clear();
      if (status == TargetStatus::kTracking) last_measured_ = forecast->stamp;
      tick.forecasts.push_back({forecast->stamp, forecast});
    }
    if (count_ % 3 == 1 && planner_answers && !planner_silent) {
      tick.plan_result = plan_result();
    }
    ++count_;
    now_ += kTickPeriod;
    const ExecutiveResult result = executive_.update(tick);
    wanted_ = result.progress.demonstration;
    check_continuity(result);
    if (arm_follows && result.setpoint) hand = result.setpoint->pose;
    return result;
  }

  // Ticks until the state is reached; the result of the last tick.
  ExecutiveResult until(ExecutionState state, double seconds) {
    ExecutiveResult result = tick();
    for (const Stamp end = now_ + from_seconds(seconds); result.progress.state != state;) {
      if (now_ > end) {
        ADD_FAILURE() << "still " << name(result.progress.state) << ", not " << name(state) << ": "
                      << result.progress.reason;
        break;
      }
      result = tick();
    }
    return result;
  }

  ExecutiveResult run(double seconds) {
    ExecutiveResult result;
    for (const Stamp end = now_ + from_seconds(seconds); now_ < end;) result = tick();
    return result;
  }

  SkillExecutive& executive() { return executive_; }
  void forget_setpoint() { setpoint_.reset(); }  // the arm was moved meanwhile
  void leap(double seconds) { now_ += from_seconds(seconds); }

  Pose hand = pose_at(0.3, 0, 0.5);  // measured; where the straight skill begins
  bool hand_known = true;
  bool checks_steps = true;  // no: the velocity changes faster than the set-point follows
  bool arm_follows = true;
  bool control_fails = false;
  bool control_silent = false;
  Eigen::Vector3d position = kTarget;
  Eigen::Vector3d velocity = kStill;
  double measured_off = 0;  // velocity between two images, from the filter's, m/s
  TargetStatus status = TargetStatus::kTracking;
  bool forecast_silent = false;
  bool planner_silent = false;
  bool planner_answers = true;
  std::shared_ptr<const Trajectory> plan = std::make_shared<Trajectory>(straight_skill());
  std::map<std::string, std::shared_ptr<const Trajectory>> others;  // by demonstration

 private:
  PlanResult plan_result() const {
    PlanResult result{now_ - kTickPeriod, plan, plan ? "" : "no solution", wanted_.number, false};
    if (wanted_.name.empty()) return result;
    const auto found = others.find(wanted_.name);
    result.refused = found == others.end();
    result.plan = result.refused ? nullptr : found->second;
    if (!result.plan) result.message = result.refused ? "no such file" : "no solution";
    return result;
  }

  void check_continuity(const ExecutiveResult& result) {
    if (!result.setpoint || !checks_steps) return;
    const Eigen::Vector3d& at = result.setpoint->pose.position;
    // The skill runs at 0.3 m/s, on the approach across the target's motion; the gap closes at
    // 0.2 m/s on top of it.
    const double fastest = std::hypot(0.3 * 1.2, velocity.norm()) + 0.2;
    if (setpoint_) {
      EXPECT_LT((at - *setpoint_).norm(), fastest * to_seconds(kTickPeriod) + 1e-9);
    }
    setpoint_ = at;
  }

  SkillExecutive executive_;
  Stamp now_ = std::chrono::seconds(50);
  Stamp last_measured_{0};
  int count_ = 0;
  NamedDemonstration wanted_;
  std::optional<Eigen::Vector3d> setpoint_;
};

}  // namespace prf_decision
