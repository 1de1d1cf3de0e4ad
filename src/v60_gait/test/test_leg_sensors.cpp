// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/leg_sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace v60_gait {
namespace {

TEST(LegSensors, AreNoisyAndRepeatable) {
  LegSensors first(5, 0.001), second(5, 0.001), other(6, 0.001);
  double squares = 0.0, differences = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const LegObservation seen = first.measure({});
    EXPECT_EQ(seen.angular_velocity, second.measure({}).angular_velocity);
    differences += (seen.positions - other.measure({}).positions).norm();
    squares += seen.angular_velocity.squaredNorm() / 3.0;
    EXPECT_LT(seen.attitude.angularDistance(Eigen::Quaterniond::Identity()), 0.02);
  }
  EXPECT_NEAR(std::sqrt(squares / 2000.0), 1.5e-3, 1e-4);
  EXPECT_GT(differences, 0.0);
}

TEST(LegSensors, HaveTheStatedNoise) {
  constexpr int kSamples = 20000;
  LegSensors sensors(7, 0.1);  // 2000 s: a hundred times the memory of the attitude's error
  double positions = 0.0, velocities = 0.0, attitude = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const LegObservation seen = sensors.measure({});
    positions += seen.positions.squaredNorm() / 12.0;
    velocities += seen.velocities.squaredNorm() / 12.0;
    attitude += std::pow(seen.attitude.angularDistance(Eigen::Quaterniond::Identity()), 2) / 3.0;
  }
  EXPECT_NEAR(std::sqrt(positions / kSamples), 1e-4, 1e-6);
  EXPECT_NEAR(std::sqrt(velocities / kSamples), 3e-3, 3e-5);
  EXPECT_NEAR(std::sqrt(attitude / kSamples), 2e-3, 3e-4);
}

}  // namespace
}  // namespace v60_gait
