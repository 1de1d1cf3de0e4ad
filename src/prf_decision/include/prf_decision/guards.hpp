// SPDX-License-Identifier: BSD-3-Clause
// The guards: checks of what the HMM cannot see, whether arm, target, forecast, plan and goal can
// be acted on at all. They are the rows of one table, tried in its order as far as the first
// violation. What is wrong with the arm does not end the search: the graver violation counts, else
// the first. A forecast is judged as far ahead as the execution uses it, which is up to goal_time:
// a longer horizon may be wrong without harm.
#pragma once

#include <arm_kinematics/arm_kinematics.hpp>
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "prf_decision/decision_fsm.hpp"
#include "prf_decision/following_monitor.hpp"
#include "prf_decision/types.hpp"

namespace prf_decision {

struct GuardParams {
  Duration max_gap{0};        // between ticks, parameter max_wait
  Duration pause_after{0};    // since the last measurement, T1 = coast_limits[0]
  Duration reverse_after{0};  // T2 = coast_limits[1] > T1
  Duration stop_after{0};     // T3 = coast_limits[2] > T2
  Eigen::Vector3d shoulder = Eigen::Vector3d::Zero();        // of the arm, in the planning frame, m
  double max_reach = 0;                                      // hand from the shoulder, m
  double workspace_radius = 0;                               // target from the shoulder, m
  double max_target_speed = 0;                               // m/s
  double clearance = 0;                                      // of the task, m
  std::shared_ptr<const arm_kinematics::ArmKinematics> arm;  // that shall reach the goal
  FollowingParams following;

  // std::invalid_argument names the parameter, its value and the bound.
  void validate() const;
};

struct GuardInput {
  Stamp tick{0};
  Stamp goal_time{0};           // at which the hand shall be at the goal
  Duration since_last_tick{0};  // 0 at the first one
  const FollowingMonitor* following{};
  bool has_goal = false;               // of the action, or the one that starts by itself
  std::optional<Stamp> measured;       // last measurement of the target
  const TargetForecast* forecast{};    // the newest one, present once the target was measured
  bool forecast_silent = false;        // no forecast for longer than max_wait
  const Trajectory* plan{};            // of the demonstration to execute
  std::optional<std::string> no_plan;  // reason, when the planner's last result has no plan
  bool planner_silent = false;         // no result of the planner for longer than max_wait
  std::optional<double> holdable;      // ShadowArm::holdable() at the start of the skill, m
};

struct Violation {
  Event event = Event::kHazard;
  std::string reason;
};

using Check = std::optional<Violation>(const GuardParams& params, const GuardInput& input);

// Each check may rely on the ones before it in the table.
Check check_has_goal, check_ticks, check_following, check_measured, check_age, check_forecast_heard,
    check_status, check_forecast, check_has_plan, check_planner_heard, check_plan_result,
    check_goal, check_ability;

struct Guard {
  const char* name;
  bool adapted_once;      // also where the skill is adapted once and executed blindly
  const char* violation;  // what it reports
  const char* events;     // for the table; the check chooses the event
  Check* check;
};

// clang-format off
inline constexpr std::array kGuards{
    //    name             once   violation                                                                events
    Guard{"goal given",    true,  "no goal of `execute_skill` yet",                                        "hazard", check_has_goal},
    Guard{"ticks",         true,  "`joint_states` silent for longer than `max_wait`",                      "hazard", check_ticks},
    Guard{"following",     true,  "the hand off its set-point, or `control/status` failing or silent, for `following_limits` [0], [1], [2]", "hazard, overdue, give up", check_following},
    Guard{"measured",      false, "the target was never measured",                                         "hazard", check_measured},
    Guard{"age",           false, "last measurement older than `coast_limits` [0], [1], [2]",              "hazard, overdue, lost", check_age},
    Guard{"forecast heard", false, "`target/forecast` silent for longer than `max_wait`",                  "hazard", check_forecast_heard},
    Guard{"status",        false, "the predictor has no target, or lost it",                               "hazard", check_status},
    Guard{"forecast",      false, "a prediction in use outside `workspace_radius` or above `max_target_speed`", "hazard", check_forecast},
    Guard{"plan",          true,  "no plan yet",                                                           "hazard", check_has_plan},
    Guard{"planner heard", false, "`skill/trajectory` silent for longer than `max_wait`",                  "hazard", check_planner_heard},
    Guard{"plan result",   false, "the planner's last result has no plan",                                 "hazard", check_plan_result},
    Guard{"reach",         false, "goal beyond `max_reach`, or no joint position within limits gives it",  "hazard", check_goal},
    Guard{"ability",       false, "at the start of the skill: what the arm can hold here is beyond `clearance`", "hazard", check_ability},
};
// clang-format on

// The violation that counts, of all guards or of those that hold where the skill is adapted once.
[[nodiscard]] std::optional<Violation> check_guards(const GuardParams& params,
                                                    const GuardInput& input, bool adapted_once);

// Where the hand shall be at `time`, moving with the target: the plan's goal_in_target on the
// predicted target. Throws std::invalid_argument when the forecast has no predictions.
[[nodiscard]] MovingPose goal_at(const TargetForecast& forecast, const Trajectory& plan,
                                 Stamp time);

// The table for people, as Markdown.
[[nodiscard]] std::string guards_markdown();

}  // namespace prf_decision
