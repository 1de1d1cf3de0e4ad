// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/reference_generator.hpp"

#include <gtest/gtest.h>

#include "scenario.hpp"

namespace prf_decision {
namespace {

const Eigen::Vector3d kTarget(1.0, 0, 0.5);  // puts the hand where the straight skill ends
constexpr Stamp kStart = std::chrono::seconds(50);

ReferenceInput input_at(int tick, ExecutionState state) {
  ReferenceInput input;
  input.stamp = kStart + tick * kTickPeriod;
  input.since_last_tick = kTickPeriod;
  input.state = state;
  input.hand_on_goal = true;
  return input;
}

PlannedSkill planned(const TargetForecast& forecast) {
  return {std::make_shared<Trajectory>(straight_skill()), kStart,
          std::make_shared<TargetForecast>(forecast)};
}

TEST(ReferenceGenerator, IsAtTheStartOnlyWithTheHandsOrientation) {
  ReferenceGenerator generator(usual_params().reference);
  generator.update_plan(planned(forecast_of(kStart, kTarget, {0, 0, 0})));
  int ticks = 0;
  for (ReferenceResult result; !result.at_start; ++ticks) {
    ASSERT_LT(ticks, 200);
    ReferenceInput input = input_at(ticks, ExecutionState::kReverse);
    input.hand = straight_skill().poses[0];
    input.hand->orientation = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX());
    result = generator.step(input);
  }
  EXPECT_NEAR(ticks, 90, 2);  // from 0.5 to 0.05 rad at 0.5 rad/s
}

TEST(ReferenceGenerator, StandsWhereTheTargetWasLastWithoutAForecast) {
  ReferenceParams params = usual_params().reference;
  params.approach_length = 1.0;
  ReferenceGenerator generator(params);
  const TargetForecast forecast = forecast_of(kStart, kTarget, {0, 0.1, 0});
  generator.update_plan(planned(forecast));
  std::optional<MovingPose> moving, still;
  for (int tick = 0; tick < 400; ++tick) {
    ReferenceInput input = input_at(tick, ExecutionState::kPause);
    if (tick <= 40) input.forecast = &forecast;
    const ReferenceResult result = generator.step(input);
    if (tick == 40) moving = result.setpoint;
    still = result.setpoint;
  }
  ASSERT_TRUE(moving && still);
  EXPECT_NEAR(moving->linear_velocity.y(), 0.1, 1e-3);
  EXPECT_LT(still->linear_velocity.norm(), 1e-9);
  // 0.4 s and the lead after the forecast.
  EXPECT_NEAR(still->pose.position.y(), 0.1 * 0.42, 1e-6);
}

TEST(ReferenceGenerator, HoldsInTrackingAtAViolationOrWithoutAForecast) {
  ReferenceGenerator generator(usual_params().reference);
  const TargetForecast forecast = forecast_of(kStart, kTarget, {0, 0.1, 0});
  generator.update_plan(planned(forecast));
  ReferenceInput input = input_at(1, ExecutionState::kTracking);
  input.forecast = &forecast;
  ASSERT_GT(generator.step(input).setpoint->linear_velocity.norm(), 0.05);
  EXPECT_TRUE(generator.tracked_for(input.stamp));
  for (const bool violation : {true, false}) {
    input = input_at(2, ExecutionState::kTracking);
    if (violation) input.forecast = &forecast;
    input.violation = violation;
    EXPECT_EQ(generator.step(input).setpoint->linear_velocity.norm(), 0);
    EXPECT_FALSE(generator.tracked_for(input.stamp));
  }
}

TEST(ReferenceGenerator, SlowsTheCursorAndItsVelocityAlike) {
  const auto after_a_second = [](double speed) {
    ReferenceGenerator generator(usual_params().reference);
    generator.update_plan(planned(forecast_of(kStart, kTarget, {0, 0, 0})));
    ReferenceResult result;
    for (int tick = 0; tick < 100; ++tick) {
      ReferenceInput input = input_at(tick, ExecutionState::kForward);
      input.hand = straight_skill().poses[0];
      input.speed = speed;
      result = generator.step(input);
    }
    return std::pair(generator.cursor(), result.setpoint->linear_velocity.norm());
  };
  const auto [whole, fast] = after_a_second(1.0);
  const auto [share, slow] = after_a_second(0.25);
  EXPECT_NEAR(share, 0.25 * whole, 1e-6);
  EXPECT_NEAR(slow, 0.25 * fast, 1e-6);
  const auto [none, standing] = after_a_second(0.0);
  EXPECT_EQ(none, 0.0);
  EXPECT_EQ(standing, 0.0);
}

}  // namespace
}  // namespace prf_decision
