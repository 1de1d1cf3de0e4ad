// SPDX-License-Identifier: BSD-3-Clause
#include "ability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <jaco_kinematics/jaco_arm.hpp>
#include <jaco_kinematics/jaco_kinematics.hpp>
#include <limits>
#include <memory>

namespace prf_studies {
namespace {

using prf_core::from_seconds;
using prf_core::Stamp;
using prf_core::to_seconds;
using prf_decision::Intent;

prf_control::JointVector ready_pose() {
  prf_control::JointVector q(7);
  q << 1.600, 1.372, 0.516, 0.967, -1.637, 2.307, -0.298;
  return q;
}

AbilityParams standing_params() {
  AbilityParams params;
  params.arm = {0.95, 4.0, std::make_shared<jaco_kinematics::JacoArm>()};
  params.start = ready_pose();
  params.warm_up = 0;
  return params;
}

// A target at the hand's start that sways along y, known without error.
ObservedRun swaying(double amplitude, double rate, double seconds) {
  const Eigen::Isometry3d hand = jaco_kinematics::forward(ready_pose());
  const auto truth = [=](Stamp stamp) {
    prf_core::Pose pose = prf_core::pose_from(hand);
    pose.position.y() += amplitude * (1 - std::cos(rate * (to_seconds(stamp) - 1)));
    return std::optional(pose);
  };
  ObservedRun run;
  run.truth = truth;
  for (int k = 0; k < 30 * seconds; ++k) {
    prf_core::TargetForecast forecast;
    forecast.stamp = from_seconds(1 + k / 30.0);
    forecast.status = prf_core::TargetStatus::kTracking;
    for (const double horizon : {0.0, 0.05, 0.1, 0.15, 0.2}) {
      prf_core::TargetPrediction prediction;
      prediction.horizon = from_seconds(horizon);
      const double t = to_seconds(forecast.stamp) - 1 + horizon;
      prediction.target.pose = *truth(forecast.stamp + prediction.horizon);
      prediction.target.linear_velocity.y() = amplitude * rate * std::sin(rate * t);
      forecast.predictions.push_back(prediction);
    }
    run.forecasts.push_back(forecast);
  }
  return run;
}

TEST(Ability, HoldsWhatTheLimitsAllowAndNotWhatIsTooFast) {
  const AbilityParams params = standing_params();
  const auto slow = follow(swaying(0.05, 1.5, 6), params).instants;
  const auto fast = follow(swaying(0.10, 12.0, 6), params).instants;
  EXPECT_LT(held_within(slow, 1.0, params), 0.005);
  EXPECT_GT(held_within(fast, 0.5, params), params.clearance);
}

// Deviations are given: the labels are those of the largest one within the horizon.
TEST(Ability, LabelsByTheLargestDeviationWithinTheHorizon) {
  AbilityParams params = standing_params();
  params.latency = 0;
  params.horizon = 0.1;
  ObservedRun run;
  std::vector<Instant> instants;
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.01 * k;
    const double deviation = k == 50 ? 0.05 : k == 80 ? 0.07 : 0.01;
    instants.push_back({from_seconds(t), deviation});
    run.forecasts.emplace_back();
    run.forecasts.back().stamp = from_seconds(t);
  }
  const auto found = labels(run, instants, params);
  for (int k = 0; k <= 90; ++k) {
    const Intent right = k >= 70 && k <= 80   ? Intent::kReverse
                         : k >= 40 && k <= 50 ? Intent::kPause
                                              : Intent::kForward;
    ASSERT_TRUE(found[static_cast<std::size_t>(k)]) << k;
    EXPECT_EQ(*found[static_cast<std::size_t>(k)], right) << k;
  }
  for (std::size_t k = 91; k <= 100; ++k) EXPECT_FALSE(found[k]) << k;
}

TEST(Ability, LabelsNothingWhereTheTruthIsNotKnownNorDuringTheWarmUp) {
  AbilityParams params = standing_params();
  params.latency = 0;
  params.horizon = 0.1;
  params.warm_up = 0.2;
  ObservedRun run;
  std::vector<Instant> instants;
  for (int k = 0; k <= 100; ++k) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    instants.push_back({from_seconds(0.01 * k), k == 50 ? unknown : 0.0});
    run.forecasts.emplace_back();
    run.forecasts.back().stamp = from_seconds(0.01 * k);
  }
  const auto found = labels(run, instants, params);
  for (std::size_t k = 0; k <= 90; ++k) {
    EXPECT_EQ(found[k].has_value(), k >= 20 && (k < 40 || k > 50)) << k;
  }
}

TEST(Ability, RefusesARunWithoutATarget) {
  ObservedRun run;
  run.forecasts.resize(3);
  EXPECT_THROW(static_cast<void>(follow(run, standing_params())), std::invalid_argument);
}

}  // namespace
}  // namespace prf_studies
