// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/motion.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "scenario.hpp"

namespace prf_decision {
namespace {

// Circle of 0.1 m at 2 rad/s while turning about z at 0.7 rad/s.
MovingPose circling(double t) {
  MovingPose at;
  at.pose.position = {0.1 * std::cos(2 * t), 0.1 * std::sin(2 * t), 0.5};
  at.pose.orientation = Eigen::AngleAxisd(0.7 * t, Eigen::Vector3d::UnitZ());
  at.linear_velocity = {-0.2 * std::sin(2 * t), 0.2 * std::cos(2 * t), 0};
  at.angular_velocity = {0, 0, 0.7};
  return at;
}

Forecast circling_forecast() {
  Forecast forecast;
  forecast.stamp = std::chrono::seconds(5);
  forecast.status = TargetStatus::kTracking;
  for (const double horizon : {0.0, 0.1, 0.25, 0.5}) {
    forecast.predictions.push_back({from_seconds(horizon), circling(horizon)});
  }
  return forecast;
}

TEST(TargetAt, FollowsAMotionBetweenItsHorizons) {
  const Forecast forecast = circling_forecast();
  for (double t = 0; t <= 0.5; t += 0.005) {
    const MovingPose at = target_at(forecast, forecast.stamp + from_seconds(t));
    const MovingPose truth = circling(t);
    // Cubic Hermite error: h^4 / 384 max |x''''| = 0.25^4 / 384 * 1.6 m.
    EXPECT_LT((at.pose.position - truth.pose.position).norm(), 2e-5);
    EXPECT_LT((at.linear_velocity - truth.linear_velocity).norm(), 1e-3);
    EXPECT_LT(at.pose.orientation.angularDistance(truth.pose.orientation), 1e-7);
    EXPECT_LT((at.angular_velocity - truth.angular_velocity).norm(), 1e-9);
  }
}

TEST(TargetAt, StandsBeyondTheLastHorizon) {
  const Forecast forecast = circling_forecast();
  const MovingPose at = target_at(forecast, forecast.stamp + from_seconds(3));
  EXPECT_EQ(at.pose.position, forecast.predictions.back().target.pose.position);
  EXPECT_EQ(at.linear_velocity.norm(), 0);
}

TEST(TargetAt, RefusesAForecastWithoutPredictions) {
  EXPECT_THROW((void)target_at(Forecast(), Stamp{0}), std::invalid_argument);
}

TEST(Attached, HasTheVelocityOfARigidBody) {
  const Pose lever{{-0.3, 0.1, 0.05}, {0.5, 0.5, 0.5, 0.5}};
  const double h = 1e-6;
  const MovingPose before = attached(circling(0.3 - h), lever);
  const MovingPose at = attached(circling(0.3), lever);
  const MovingPose after = attached(circling(0.3 + h), lever);
  const Eigen::Vector3d slope = (after.pose.position - before.pose.position) / (2 * h);
  EXPECT_LT((at.linear_velocity - slope).norm(), 1e-8);
  const Eigen::Vector3d turn =
      rotation_between(before.pose.orientation, after.pose.orientation) / (2 * h);
  EXPECT_LT((at.angular_velocity - turn).norm(), 1e-6);
}

TEST(RotationBetween, TakesTheShortWay) {
  const Eigen::Quaterniond from(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  Eigen::Quaterniond to(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  to.coeffs() = -to.coeffs();
  EXPECT_LT((rotation_between(from, to) - Eigen::Vector3d(0.3, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(rotation_between(from, from).norm(), 0);
}

template <typename Value>
void expect_refused(
    const Value& valid,
    const std::vector<std::pair<std::string, std::function<void(Value&)>>>& catalogue) {
  ASSERT_NO_THROW(valid.validate());
  for (const auto& [culprit, spoil] : catalogue) {
    Value value = valid;
    spoil(value);
    try {
      value.validate();
      ADD_FAILURE() << "accepted: " << culprit;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(culprit), std::string::npos) << error.what();
    }
  }
}

TEST(Forecast, RefusesWhatCannotBeActedOn) {
  expect_refused<Forecast>(
      circling_forecast(),
      {{"predictions are empty", [](auto& f) { f.predictions.clear(); }},
       {"since_measurement", [](auto& f) { f.since_measurement = Duration{-1}; }},
       {"predictions[0].horizon", [](auto& f) { f.predictions[0].horizon = Duration{1}; }},
       {"predictions[2].horizon",
        [](auto& f) { f.predictions[2].horizon = f.predictions[1].horizon; }},
       {"predictions[1].position",
        [](auto& f) { f.predictions[1].target.pose.position.x() = NAN; }},
       {"predictions[1].orientation",
        [](auto& f) { f.predictions[1].target.pose.orientation.coeffs().setZero(); }},
       {"predictions[3].twist",
        [](auto& f) { f.predictions[3].target.linear_velocity.x() = INFINITY; }}});
}

TEST(Trajectory, RefusesWhatCannotBeExecuted) {
  expect_refused<Trajectory>(
      straight_skill(),
      {{"poses has 1", [](auto& t) { t.poses.resize(1); }},
       {"time_from_start has 12", [](auto& t) { t.times.push_back(Duration{1}); }},
       {"time_from_start[0]", [](auto& t) { t.times[0] = Duration{1}; }},
       {"time_from_start[4]", [](auto& t) { t.times[4] = t.times[3]; }},
       {"poses[7].position", [](auto& t) { t.poses[7].position.z() = NAN; }},
       {"poses[10].orientation", [](auto& t) { t.poses[10].orientation.w() = 0.5; }},
       {"goal_in_target", [](auto& t) { t.goal_in_target.orientation.w() = NAN; }}});
}

}  // namespace
}  // namespace prf_decision
