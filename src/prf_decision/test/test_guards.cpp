// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/guards.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "scenario.hpp"

namespace prf_decision {
namespace {

TEST(Guards, GradeTheAgeOfTheTarget) {
  const GuardParams guards = usual_guards();
  EXPECT_FALSE(object_to_age(guards, from_seconds(0.3)));
  EXPECT_EQ(object_to_age(guards, from_seconds(0.31))->event, Event::kHazard);
  EXPECT_EQ(object_to_age(guards, from_seconds(1.01))->event, Event::kOverdue);
  EXPECT_EQ(object_to_age(guards, from_seconds(2.01))->event, Event::kLost);
  EXPECT_EQ(object_to_age(guards, from_seconds(0.62))->reason,
            "target unseen for 0.62 s, limit 0.30 s");
}

TEST(Guards, RefuseAForecastThatLeavesTheWorkspace) {
  const GuardParams guards = usual_guards();
  const Eigen::Vector3d target(0.9, 0, 0.65);
  EXPECT_FALSE(object_to_forecast(guards, forecast_of(Stamp{0}, target, {1.4, 0, 0})));
  EXPECT_EQ(object_to_forecast(guards, forecast_of(Stamp{0}, {2.1, 0, 0.2755}, {0, 0, 0}))->reason,
            "forecast 2.10 m from the shoulder in 0.00 s, limit 2.00 m");
  EXPECT_EQ(
      object_to_forecast(guards, forecast_of(Stamp{0}, {1.9, 0, 0.2755}, {0.5, 0, 0}))->reason,
      "forecast 2.15 m from the shoulder in 0.50 s, limit 2.00 m");
  EXPECT_EQ(object_to_forecast(guards, forecast_of(Stamp{0}, target, {0, 1.6, 0}))->reason,
            "forecast speed 1.60 m/s in 0.00 s, limit 1.50 m/s");
}

TEST(Guards, RefuseAGoalOutOfReach) {
  const GuardParams guards = usual_guards();
  Pose goal;
  goal.orientation = Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitY());  // the hand looks along x
  goal.position = {0.9, 0, 0.2755};
  EXPECT_FALSE(object_to_goal(guards, goal));
  goal.position = {0, -1.02, 0.2755};
  EXPECT_EQ(object_to_goal(guards, goal)->reason, "goal 1.02 m from the shoulder, reach 0.95 m");
  goal.position = {0.4, 0, 0.2755};  // the forearm would have to fold into the upper arm
  EXPECT_EQ(object_to_goal(guards, goal)->reason, "no joint position within limits gives the goal");
}

TEST(Guards, RefuseTheirOwnParametersByName) {
  const std::vector<std::pair<std::string, std::function<void(GuardParams&)>>> catalogue{
      {"coast_limits[0]", [](auto& g) { g.pause_after = Duration{0}; }},
      {"coast_limits[1]", [](auto& g) { g.reverse_after = g.pause_after; }},
      {"coast_limits[2]", [](auto& g) { g.stop_after = g.pause_after; }},
      {"max_reach", [](auto& g) { g.max_reach = 0; }},
      {"workspace_radius", [](auto& g) { g.workspace_radius = INFINITY; }},
      {"max_target_speed", [](auto& g) { g.max_target_speed = NAN; }},
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
