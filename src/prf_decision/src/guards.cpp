// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/guards.hpp"

#include <prf_core/require.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "sentence.hpp"

namespace prf_decision {

using prf_core::require;

namespace {

Violation hazard(std::string reason) { return {Event::kHazard, std::move(reason)}; }

int severity(Event event) {
  return event == Event::kGiveUp ? 3 : event == Event::kLost ? 2 : event == Event::kOverdue ? 1 : 0;
}

}  // namespace

void GuardParams::validate() const {
  using prf_core::require_between;
  require_between("max_wait", to_seconds(max_gap), 0.05, 10, "s");
  require_between("coast_limits[0]", to_seconds(pause_after), 0.05, 60, "s");
  require_between("coast_limits[1]", to_seconds(reverse_after), 0.05, 60, "s");
  require_between("coast_limits[2]", to_seconds(stop_after), 0.05, 600, "s");
  require(reverse_after > pause_after, "coast_limits[1]", to_seconds(reverse_after),
          "> coast_limits[0] = " + std::to_string(to_seconds(pause_after)) + " s");
  require(stop_after > reverse_after, "coast_limits[2]", to_seconds(stop_after),
          "> coast_limits[1] = " + std::to_string(to_seconds(reverse_after)) + " s");
  for (const double entry : shoulder) require_between("shoulder", entry, -2, 2, "m");
  require_between("max_reach", max_reach, 0.1, 2, "m");
  require_between("workspace_radius", workspace_radius, 0.1, 20, "m");
  require_between("max_target_speed", max_target_speed, 0.01, 10, "m/s");
  require_between("clearance", clearance, 1e-3, 1, "m");
  following.validate();
  if (!arm) throw std::invalid_argument("the guards need an arm");
}

std::optional<Violation> check_has_goal(const GuardParams&, const GuardInput& input) {
  if (input.has_goal) return std::nullopt;
  return hazard("no goal yet");
}

std::optional<Violation> check_ticks(const GuardParams& params, const GuardInput& input) {
  const Duration gap = input.since_last_tick;
  if (gap <= params.max_gap) return std::nullopt;
  return hazard(sentence("joint_states silent for ", to_seconds(gap), " s"));
}

std::optional<Violation> check_following(const GuardParams& params, const GuardInput& input) {
  const auto& [pause_after, reverse_after, stop_after] = params.following.limits;
  const Duration lasting = input.following->lasting(input.tick);
  const Duration in_all = input.following->off_in_all();
  const auto off = [&](Event event) {
    return Violation{event,
                     sentence(input.following->trouble(), ", for ", to_seconds(lasting), " s")};
  };
  if (lasting > stop_after) return off(Event::kGiveUp);
  if (lasting > pause_after && in_all > stop_after) {
    Violation often = off(Event::kGiveUp);
    often.reason += sentence(", off again and again for ", to_seconds(in_all), " s");
    return often;
  }
  if (lasting > reverse_after) return off(Event::kOverdue);
  if (lasting > pause_after) return off(Event::kHazard);
  return std::nullopt;
}

std::optional<Violation> check_measured(const GuardParams&, const GuardInput& input) {
  if (input.measured) return std::nullopt;
  return hazard("target not seen yet");
}

std::optional<Violation> check_age(const GuardParams& params, const GuardInput& input) {
  const Duration age = input.tick - *input.measured;
  const auto too_old = [&](Event event, Duration limit) {
    return Violation{event, sentence("no measurement of the target for ", to_seconds(age),
                                     " s, limit ", to_seconds(limit), " s")};
  };
  if (age > params.stop_after) return too_old(Event::kLost, params.stop_after);
  if (age > params.reverse_after) return too_old(Event::kOverdue, params.reverse_after);
  if (age > params.pause_after) return too_old(Event::kHazard, params.pause_after);
  return std::nullopt;
}

std::optional<Violation> check_forecast_heard(const GuardParams&, const GuardInput& input) {
  if (!input.forecast_silent) return std::nullopt;
  const Duration silence = input.tick - input.forecast->stamp;
  return hazard(sentence("forecast silent for ", to_seconds(silence), " s"));
}

std::optional<Violation> check_status(const GuardParams&, const GuardInput& input) {
  const TargetStatus status = input.forecast->status;
  if (status == TargetStatus::kTracking || status == TargetStatus::kCoasting) return std::nullopt;
  return hazard("predictor has lost the target");
}

// Comparisons are written so that not-a-number is a violation.
std::optional<Violation> check_forecast(const GuardParams& params, const GuardInput& input) {
  const auto refused = [&](const prf_core::TargetPrediction& prediction) {
    const auto& [horizon, target, covariance] = prediction;
    const double distance = (target.pose.position - params.shoulder).norm();
    if (!(distance <= params.workspace_radius)) {
      return sentence("forecast ", distance, " m from the shoulder in ", to_seconds(horizon),
                      " s, limit ", params.workspace_radius, " m");
    }
    const double speed = target.linear_velocity.norm();
    if (!(speed <= params.max_target_speed)) {
      return sentence("forecast speed ", speed, " m/s in ", to_seconds(horizon), " s, limit ",
                      params.max_target_speed, " m/s");
    }
    return std::string();
  };
  std::string reason;
  for (const auto& prediction : input.forecast->predictions) {
    if (prediction.horizon > input.goal_time - input.forecast->stamp) break;
    if (reason.empty()) reason = refused(prediction);
  }
  if (reason.empty() && !input.forecast->predictions.empty()) {
    reason = refused(predicted_target(*input.forecast, input.goal_time));
  }
  if (reason.empty()) return std::nullopt;
  return hazard(reason);
}

std::optional<Violation> check_has_plan(const GuardParams&, const GuardInput& input) {
  if (input.plan) return std::nullopt;
  return hazard("no plan yet" + (input.no_plan ? ": " + *input.no_plan : ""));
}

std::optional<Violation> check_planner_heard(const GuardParams&, const GuardInput& input) {
  if (!input.planner_silent) return std::nullopt;
  return hazard("planner silent");
}

std::optional<Violation> check_plan_result(const GuardParams&, const GuardInput& input) {
  if (!input.no_plan) return std::nullopt;
  return hazard("planner has no plan: " + *input.no_plan);
}

std::optional<Violation> check_goal(const GuardParams& params, const GuardInput& input) {
  const Pose goal = goal_at(*input.forecast, *input.plan, input.goal_time).pose;
  const double distance = (goal.position - params.shoulder).norm();
  if (!(distance <= params.max_reach)) {
    return hazard(
        sentence("goal ", distance, " m from the shoulder, reach ", params.max_reach, " m"));
  }
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(goal.position) * goal.orientation.normalized();
  if (params.arm->reaches(pose)) return std::nullopt;
  return hazard("no joint position within limits gives the goal");
}

std::optional<Violation> check_ability(const GuardParams& params, const GuardInput& input) {
  if (!input.holdable || *input.holdable <= params.clearance) return std::nullopt;
  return hazard(sentence("this arm can hold ", 1e3 * *input.holdable, " mm here, the task needs ",
                         1e3 * params.clearance, " mm"));
}

std::optional<Violation> check_guards(const GuardParams& params, const GuardInput& input,
                                      bool adapted_once) {
  std::optional<Violation> worst;
  for (const Guard& guard : kGuards) {
    if (adapted_once && !guard.adapted_once) continue;
    auto violation = guard.check(params, input);
    if (!violation) continue;
    if (!worst || severity(violation->event) > severity(worst->event)) worst = violation;
    if (guard.check != check_following) break;
  }
  return worst;
}

MovingPose goal_at(const TargetForecast& forecast, const Trajectory& plan, Stamp time) {
  return prf_core::rigidly_attached(predicted_target(forecast, time).target, plan.goal_in_target);
}

std::string guards_markdown() {
  std::ostringstream table;
  table << "| guard | violation | event | also adapted once |\n|---|---|---|---|\n";
  for (const Guard& guard : kGuards) {
    table << "| " << guard.name << " | " << guard.violation << " | " << guard.events << " | "
          << (guard.adapted_once ? "yes" : "no") << " |\n";
  }
  return table.str();
}

}  // namespace prf_decision
