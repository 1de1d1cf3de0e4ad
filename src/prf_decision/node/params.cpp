// SPDX-License-Identifier: BSD-3-Clause
#include "params.hpp"

#include <cmath>
#include <prf_core/require.hpp>

#include "prf_decision/hmm/hmm_file.hpp"

namespace prf_decision {
namespace {

// Bounded before it becomes whole nanoseconds, which cannot hold NaN or infinity.
Duration checked_seconds(const std::string& name, double value) {
  constexpr double kLongest = 1e6;  // s, 11 days: longer than any run
  prf_core::require(std::abs(value) <= kLongest, name, value, "finite and at most 1e6 s");
  return from_seconds(value);
}

FollowingParams load_following(prf_ros::PrivateParameters& values) {
  FollowingParams following;
  const auto path = values.numbers("following_tolerance", 2);
  const auto goal = values.numbers("goal_tolerance", 2);
  const auto limits = values.numbers("following_limits", 3);
  following.path = {path[0], path[1]};
  following.goal = {goal[0], goal[1]};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    following.limits[i] = checked_seconds("following_limits", limits[i]);
  }
  return following;
}

GuardParams load_guards(prf_ros::PrivateParameters& values, const Robot& robot) {
  GuardParams guards;
  const auto coast = values.numbers("coast_limits", 3);
  guards.max_gap = checked_seconds("max_wait", values.number("max_wait"));
  guards.pause_after = checked_seconds("coast_limits[0]", coast[0]);
  guards.reverse_after = checked_seconds("coast_limits[1]", coast[1]);
  guards.stop_after = checked_seconds("coast_limits[2]", coast[2]);
  guards.shoulder = robot.shoulder;
  guards.max_reach = robot.reach;
  guards.arm = robot.kinematics;
  guards.workspace_radius = values.number("workspace_radius");
  guards.max_target_speed = values.number("max_target_speed");
  guards.clearance = values.number("clearance");
  guards.following = load_following(values);
  return guards;
}

ReferenceParams load_reference(prf_ros::PrivateParameters& values) {
  ReferenceParams params;
  params.adaptation = values.flag("framework") ? Adaptation::kContinuous : Adaptation::kOnce;
  params.lead = checked_seconds("lead", values.number("lead"));
  params.approach_length = values.number("approach_length");
  params.view_angle = values.number("view_angle");
  params.tracking_tolerance = values.number("tracking_tolerance");
  const auto speed = values.numbers("catch_up_speed", 2);
  params.catch_up = {speed[0], speed[1], values.number("catch_up_time")};
  return params;
}

DecisionParams load_decision(prf_ros::PrivateParameters& values, const Robot& robot) {
  const auto seconds = [&](const char* key) { return checked_seconds(key, values.number(key)); };
  DecisionParams params;
  params.reference = load_reference(values);
  params.autostart = values.flag("autostart");
  params.hold_time = seconds("hold_time");
  params.dwell_time = seconds("dwell_time");
  params.time_limit = seconds("time_limit");
  params.guards = load_guards(values, robot);
  const auto arm = values.numbers("arm_limits", 2);
  params.arm = {arm[0], arm[1], robot.kinematics};
  const auto search = values.numbers("search", 3);
  params.search = {checked_seconds("search[0]", search[0]), search[1], search[2], robot.kinematics};
  return params;
}

}  // namespace

void DecisionNodeParams::validate() const {
  prf_core::require_between("tick_period", tick_period, 0.001, 0.1, "s");
  gate.validate();
  decision.validate();
}

DecisionNodeParams load_params(prf_ros::PrivateParameters values) {
  const auto seconds = [&](const char* key) { return checked_seconds(key, values.number(key)); };
  DecisionNodeParams params;
  params.robot = prf_robots::load_robot(prf_robots::robot_folder(values.text("robot")));
  params.tick_period = values.number("tick_period");
  params.gate.pipeline_delay = seconds("pipeline_delay");
  params.gate.camera_period = seconds("camera_period");
  params.gate.control_delay = seconds("control_delay");
  params.gate.max_wait = seconds("max_wait");
  params.decision = load_decision(values, params.robot);
  const std::string hmm_file = values.text("hmm_file");
  values.refuse_unknown();
  params.decision.hmm = load_hmm(hmm_file);
  params.validate();
  return params;
}

std::vector<prf_ros::ReconfigurableParams::Parameter> reconfigurable_numbers(
    const DecisionParams& params) {
  return {
      {"dwell_time", to_seconds(params.dwell_time), "s, least time in a state for the HMM"},
      {"hold_time", to_seconds(params.hold_time), "s, to track until done; next execution"},
      {"lead", to_seconds(params.reference.lead), "s, the tracked goal is so much after the tick"},
      {"catch_up_time", params.reference.catch_up.time_constant,
       "s, with which a small gap closes"},
      {"tracking_tolerance", params.reference.tracking_tolerance, "m, that counts as tracking"},
      {"max_target_speed", params.guards.max_target_speed, "m/s, faster ones are refused"}};
}

DecisionParams with_reconfigured(const DecisionParams& params,
                                 const prf_ros::ReconfigurableParams::Values& values) {
  DecisionParams changed = params;
  changed.dwell_time = checked_seconds("dwell_time", values.at("dwell_time"));
  changed.hold_time = checked_seconds("hold_time", values.at("hold_time"));
  changed.reference.lead = checked_seconds("lead", values.at("lead"));
  changed.reference.catch_up.time_constant = values.at("catch_up_time");
  changed.reference.tracking_tolerance = values.at("tracking_tolerance");
  changed.guards.max_target_speed = values.at("max_target_speed");
  return changed;
}

}  // namespace prf_decision
