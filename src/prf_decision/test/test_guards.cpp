// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/guards.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "scenario.hpp"

namespace prf_decision {
namespace {

constexpr Stamp kNow = std::chrono::seconds(50);

const FollowingMonitor kFollows;

GuardInput input_with(const TargetForecast& forecast) {
  GuardInput input;
  input.following = &kFollows;
  input.tick = input.goal_time = kNow;
  input.has_goal = true;
  input.measured = kNow;
  input.forecast = &forecast;
  return input;
}

std::optional<Violation> age_violation(double age) {
  const TargetForecast forecast;
  GuardInput input = input_with(forecast);
  input.measured = kNow - from_seconds(age);
  return check_age(usual_guards(), input);
}

// Fault 15: tag lost for longer than T1, T2, T3 -> pause, go back, give up
TEST(Guards, GradeTheAgeOfTheLastMeasurement) {
  EXPECT_FALSE(age_violation(0.3));
  EXPECT_EQ(age_violation(0.31)->event, Event::kHazard);
  EXPECT_EQ(age_violation(1.01)->event, Event::kOverdue);
  EXPECT_EQ(age_violation(2.01)->event, Event::kLost);
  EXPECT_EQ(age_violation(0.62)->reason, "no measurement of the target for 0.62 s, limit 0.30 s");
}

TEST(Guards, WaitForAMotionThatTheArmCanHold) {
  const auto violation = [](std::optional<double> holdable) {
    GuardInput input;
    input.holdable = holdable;
    return check_ability(usual_guards(), input).has_value();
  };
  EXPECT_FALSE(violation(std::nullopt));
  EXPECT_FALSE(violation(0.04));
  EXPECT_TRUE(violation(0.0401));
  EXPECT_TRUE(violation(std::nan("")));
}

std::string forecast_violation(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) {
  const TargetForecast forecast = forecast_of(kNow, position, velocity);
  GuardInput input = input_with(forecast);
  input.goal_time = kNow + from_seconds(0.5);
  const auto violation = check_forecast(usual_guards(), input);
  return violation ? violation->reason : "";
}

// Fault 20: predictor diverges or leaves the workspace -> forecast refused, pause whatever the HMM
// says
TEST(Guards, RefuseAForecastThatLeavesTheWorkspace) {
  const Eigen::Vector3d target(0.9, 0, 0.65);
  EXPECT_EQ(forecast_violation(target, {1.4, 0, 0}), "");
  EXPECT_EQ(forecast_violation({2.1, 0, 0.2755}, {0, 0, 0}),
            "forecast 2.10 m from the shoulder in 0.00 s, limit 2.00 m");
  EXPECT_EQ(forecast_violation({1.9, 0, 0.2755}, {0.5, 0, 0}),
            "forecast 2.15 m from the shoulder in 0.50 s, limit 2.00 m");
  EXPECT_EQ(forecast_violation(target, {0, 1.6, 0}),
            "forecast speed 1.60 m/s in 0.00 s, limit 1.50 m/s");
}

TEST(Guards, JudgeAForecastNoFartherAheadThanTheExecutionUsesIt) {
  TargetForecast forecast = forecast_of(kNow, {0.9, 0, 0.65}, {0, 0, 0});
  forecast.predictions[2].target.pose.position.x() = 30;  // in 0.5 s; at 0.1 s it is still right
  GuardInput input = input_with(forecast);
  input.goal_time = kNow + from_seconds(0.1);
  EXPECT_FALSE(check_forecast(usual_guards(), input));
  input.goal_time = kNow + from_seconds(0.2);
  EXPECT_TRUE(check_forecast(usual_guards(), input));
}

// Fault 43: a prediction that is not a number -> a violation, as every comparison that it fails
TEST(Guards, TakeNotANumberForAViolation) {
  TargetForecast forecast = forecast_of(kNow, {0.9, 0, 0.65}, {0, 0, 0});
  forecast.predictions[0].target.pose.position.x() = NAN;
  EXPECT_TRUE(check_forecast(usual_guards(), input_with(forecast)));
  forecast = forecast_of(kNow, {0.9, 0, 0.65}, {0, 0, 0});
  forecast.predictions[0].target.linear_velocity.x() = NAN;
  EXPECT_TRUE(check_forecast(usual_guards(), input_with(forecast)));
  const Trajectory plan = straight_skill();
  GuardInput input = input_with(forecast);
  input.plan = &plan;
  forecast.predictions[0].target.linear_velocity.setZero();
  forecast.predictions[0].target.pose.position.x() = NAN;
  EXPECT_TRUE(check_goal(usual_guards(), input));
}

// The hand at this position, looking along x.
std::string goal_violation(const Eigen::Vector3d& position) {
  Trajectory plan = straight_skill();
  plan.goal_in_target = {position,
                         Eigen::Quaterniond(Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitY()))};
  const TargetForecast forecast = forecast_of(kNow, {0, 0, 0}, {0, 0, 0});
  GuardInput input = input_with(forecast);
  input.plan = &plan;
  const auto violation = check_goal(usual_guards(), input);
  return violation ? violation->reason : "";
}

// Fault 24: target out of reach -> pause, and the reason says how far it is
TEST(Guards, RefuseAGoalOutOfReach) {
  EXPECT_EQ(goal_violation({0.9, 0, 0.2755}), "");
  EXPECT_EQ(goal_violation({0, -1.02, 0.2755}), "goal 1.02 m from the shoulder, reach 0.95 m");
  // The forearm would have to fold into the upper arm.
  EXPECT_EQ(goal_violation({0.4, 0, 0.2755}), "no joint position within limits gives the goal");
}

// Each entry spoils one more input, from the last guard of the table to the first: the reported
// violation is that of the first spoilt guard.
TEST(Guards, AreTriedInTheOrderOfTheirTable) {
  const TargetForecast far = forecast_of(kNow, {5, 0, 0.5}, {0, 0, 0});
  const TargetForecast lost = forecast_of(kNow, {5, 0, 0.5}, {0, 0, 0}, TargetStatus::kLost);
  const TargetForecast beyond = forecast_of(kNow, {1.6, 0, 0.5}, {0, 0, 0});
  const TargetForecast near = forecast_of(kNow, {1.0, 0, 0.5}, {0, 0, 0});
  const Trajectory plan = straight_skill();
  GuardInput input = input_with(near);
  input.plan = &plan;
  input.holdable = 0.05;
  FollowingMonitor off;
  off.update(usual_guards().following, {kNow - from_seconds(0.2), {}, {}, {}, false});
  const std::vector<std::pair<std::string, std::function<void(GuardInput&)>>> spoilt{
      {"this arm can hold 50.00 mm here, the task needs 40.00 mm", [](auto&) {}},
      {"goal 1.22 m", [&](auto& i) { i.forecast = &beyond; }},
      {"planner has no plan: x", [](auto& i) { i.no_plan = "x"; }},
      {"planner silent", [](auto& i) { i.planner_silent = true; }},
      {"no plan yet: x", [](auto& i) { i.plan = nullptr; }},
      {"forecast 5.0", [&](auto& i) { i.forecast = &far; }},
      {"predictor has lost", [&](auto& i) { i.forecast = &lost; }},
      {"forecast silent", [](auto& i) { i.forecast_silent = true; }},
      {"no measurement", [](auto& i) { i.measured = kNow - from_seconds(0.4); }},
      {"target not seen yet", [](auto& i) { i.measured.reset(); }},
      {"the measured hand is unknown", [&](auto& i) { i.following = &off; }},
      {"joint_states silent", [](auto& i) { i.since_last_tick = from_seconds(0.31); }},
      {"no goal yet", [](auto& i) { i.has_goal = false; }}};
  ASSERT_EQ(spoilt.size(), kGuards.size());
  for (std::size_t i = 0; i < spoilt.size(); ++i) {
    const auto& [reason, spoil] = spoilt[i];
    spoil(input);
    const auto violation = check_guards(usual_guards(), input, false);
    ASSERT_TRUE(violation) << reason;
    EXPECT_EQ(violation->reason.rfind(reason, 0), 0u) << violation->reason;
    const Guard& guard = kGuards[kGuards.size() - 1 - i];
    EXPECT_NE(std::string(guard.events).find(name(violation->event)), std::string::npos);
    // Adapted once, only goal, ticks, arm and plan count.
    const auto once = check_guards(usual_guards(), input, true);
    EXPECT_EQ(once && once->reason == violation->reason, guard.adapted_once) << reason;
  }
}

TEST(Guards, LetTheGraverOfAnArmThatIsOffAndATargetThatIsOldCount) {
  const TargetForecast forecast = forecast_of(kNow, {0.9, 0, 0.65}, {0, 0, 0});
  GuardInput input = input_with(forecast);
  FollowingMonitor off;
  off.update(usual_guards().following, {kNow - from_seconds(0.2), {}, {}, {}, false});
  input.following = &off;
  EXPECT_EQ(check_guards(usual_guards(), input, false)->event, Event::kHazard);
  input.measured = kNow - from_seconds(1.5);
  EXPECT_EQ(check_guards(usual_guards(), input, false)->event, Event::kOverdue);
  FollowingMonitor longer;
  longer.update(usual_guards().following, {kNow - from_seconds(5.1), {}, {}, {}, false});
  input.following = &longer;
  input.measured = kNow - from_seconds(2.5);
  EXPECT_EQ(check_guards(usual_guards(), input, false)->event, Event::kGiveUp);
}

TEST(Guards, RefuseTheirOwnParametersByName) {
  const std::vector<std::pair<std::string, std::function<void(GuardParams&)>>> catalogue{
      {"max_wait", [](auto& g) { g.max_gap = Duration{0}; }},
      {"coast_limits[0]", [](auto& g) { g.pause_after = Duration{0}; }},
      {"coast_limits[1]", [](auto& g) { g.reverse_after = g.pause_after; }},
      {"coast_limits[2]", [](auto& g) { g.stop_after = g.pause_after; }},
      {"shoulder", [](auto& g) { g.shoulder.x() = NAN; }},
      {"max_reach", [](auto& g) { g.max_reach = 0; }},
      {"workspace_radius", [](auto& g) { g.workspace_radius = INFINITY; }},
      {"clearance", [](auto& g) { g.clearance = 0; }},
      {"max_target_speed", [](auto& g) { g.max_target_speed = NAN; }},
      {"max_reach", [](auto& g) { g.max_reach = 1e308; }},
      {"workspace_radius", [](auto& g) { g.workspace_radius = 5e-324; }},
      {"max_target_speed", [](auto& g) { g.max_target_speed = 11; }},
      {"shoulder", [](auto& g) { g.shoulder.z() = 3; }},
      {"coast_limits[2]", [](auto& g) { g.stop_after = from_seconds(1e5); }},
      {"following_tolerance[0]", [](auto& g) { g.following.path.position = 0; }},
      {"following_tolerance[1]", [](auto& g) { g.following.path.rotation = 4; }},
      {"goal_tolerance[0]", [](auto& g) { g.following.goal.position = NAN; }},
      {"following_limits[0]", [](auto& g) { g.following.limits[0] = Duration{0}; }},
      {"following_limits[2]", [](auto& g) { g.following.limits[2] = g.following.limits[1]; }},
  };
  for (const auto& [culprit, spoil] : catalogue) {
    GuardParams guards = usual_guards();
    spoil(guards);
    try {
      guards.validate();
      ADD_FAILURE() << "accepted: " << culprit;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(std::string(error.what()).rfind(culprit, 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace prf_decision
