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

}  // namespace
}  // namespace v60_gait
