// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/shadow_arm.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scenario.hpp"

namespace prf_decision {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(10);
constexpr Duration kLead = std::chrono::milliseconds(40);

prf_control::JointVector ready_pose() {
  prf_control::JointVector q(7);
  q << 1.600, 1.372, 0.516, 0.967, -1.637, 2.307, -0.298;
  return q;
}

// A target 0.2 m before the hand that sways along y; its forecast is right.
TargetForecast swaying(Stamp stamp, double amplitude, double rate) {
  TargetForecast forecast;
  forecast.stamp = stamp;
  forecast.status = TargetStatus::kTracking;
  for (const double horizon : {0.0, 0.02, 0.04, 0.06, 0.1, 0.15}) {
    prf_core::TargetPrediction prediction;
    prediction.horizon = from_seconds(horizon);
    prediction.target.pose = prf_core::pose_from(jaco_kinematics::forward(ready_pose()));
    const double t = to_seconds(stamp) - 1 + horizon;
    prediction.target.pose.position.y() += amplitude * (1 - std::cos(rate * t));
    prediction.target.linear_velocity.y() = amplitude * rate * std::sin(rate * t);
    forecast.predictions.push_back(prediction);
  }
  return forecast;
}

// What holdable() says after `seconds` of it.
std::optional<double> held(double amplitude, double rate, double seconds) {
  ShadowArm shadow({0.95, 4.0, jaco()});
  shadow.set_goal(Pose());
  TargetForecast newest = swaying(from_seconds(1), amplitude, rate);
  for (int k = 0; k < 100 * seconds; ++k) {
    const Stamp tick = from_seconds(1) + k * kTick;
    if (k % 3 == 0) {
      newest = swaying(tick, amplitude, rate);
      shadow.observe(newest);
    }
    shadow.step(tick, kTick, kLead, &newest, ready_pose());
  }
  return shadow.holdable();
}

TEST(ShadowArm, HoldsASlowTargetAndNotAFastOne) {
  const auto slow = held(0.05, 1.5, 5);
  const auto fast = held(0.10, 12.0, 5);
  ASSERT_TRUE(slow && fast);
  EXPECT_LT(*slow, 0.005);
  EXPECT_GT(*fast, 0.05);
}

TEST(ShadowArm, KnowsNothingWithoutGoalJointsOrImages) {
  ShadowArm shadow({0.95, 4.0, jaco()});
  const TargetForecast forecast = swaying(from_seconds(1), 0, 0);
  shadow.step(from_seconds(1), kTick, kLead, &forecast, ready_pose());
  EXPECT_FALSE(shadow.hand());
  shadow.set_goal(Pose());
  shadow.step(from_seconds(1), kTick, kLead, &forecast, std::nullopt);
  EXPECT_FALSE(shadow.hand());
  EXPECT_FALSE(shadow.observe(forecast));
  EXPECT_FALSE(held(0.05, 1.5, 0.3));
  EXPECT_TRUE(held(0.05, 1.5, 0.8));
}

TEST(ShadowArm, BeginsAnewForAnotherGoal) {
  ShadowArm shadow({0.95, 4.0, jaco()});
  shadow.set_goal(Pose());
  const TargetForecast forecast = swaying(from_seconds(1), 0, 0);
  for (int k = 0; k < 10; ++k) {
    shadow.step(from_seconds(1) + k * kTick, kTick, kLead, &forecast, ready_pose());
  }
  ASSERT_TRUE(shadow.hand());
  shadow.set_goal(Pose());
  EXPECT_TRUE(shadow.hand());
  shadow.set_goal({{0, 0, 0.05}, Eigen::Quaterniond::Identity()});
  EXPECT_FALSE(shadow.hand());
}

TEST(ShadowArm, BeginsAnewWhenTheTargetIsSeenElsewhereAfterAGap) {
  ShadowArm shadow({0.95, 4.0, jaco()});
  shadow.set_goal(Pose());
  Stamp tick = from_seconds(1);
  TargetForecast newest = swaying(tick, 0, 1);
  const auto watch = [&](double aside) {
    for (int k = 0; k < 100; ++k, tick += kTick) {
      if (k % 3 == 0) {
        newest = swaying(tick, 0, 1);
        for (auto& each : newest.predictions) each.target.pose.position.y() += aside;
        shadow.observe(newest);
      }
      shadow.step(tick, kTick, kLead, &newest, ready_pose());
    }
    return shadow.holdable();
  };
  EXPECT_LT(watch(0).value(), 1e-3);
  tick += ShadowArm::kGap + kTick;
  EXPECT_LT(watch(0.15).value(), 1e-3);
  EXPECT_GT(watch(0).value(), 0.05);  // without a gap it is the motion of a target that leaps
}

// Fault 17: the target is no longer seen -> the shadow stands, and says nothing of it
TEST(ShadowArm, StandsWithoutAForecast) {
  ShadowArm shadow({0.95, 4.0, jaco()});
  shadow.set_goal(Pose());
  TargetForecast forecast = swaying(from_seconds(1), 0.05, 2);
  Stamp tick = from_seconds(1);
  for (int k = 0; k < 100; ++k, tick += kTick) {
    if (k % 3 == 0) forecast = swaying(tick, 0.05, 2);
    shadow.step(tick, kTick, kLead, &forecast, ready_pose());
  }
  for (int k = 0; k < 60; ++k, tick += kTick) {
    shadow.step(tick, kTick, kLead, nullptr, ready_pose());
  }
  const Eigen::Vector3d stopped = *shadow.hand();
  shadow.step(tick, kTick, kLead, nullptr, ready_pose());
  EXPECT_LT((*shadow.hand() - stopped).norm(), 1e-4);
  forecast.status = TargetStatus::kCoasting;
  EXPECT_FALSE(shadow.deviation(forecast));
}

}  // namespace
}  // namespace prf_decision
