// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/headless.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "v60_world.hpp"

namespace platform_sim {
namespace {

TEST(RunHeadless, SamplesEvenlyFromNowToTheEndAndHoldsTheArm) {
  WorldParams config = folded_arm();
  config.motion = "heavy";
  World world(robot_urdf(), config);
  std::vector<double> times;
  run_headless(world, 0.5, 50, [&](World& now) {
    times.push_back(now.time());
    EXPECT_LT((now.joints().positions.tail<7>() - config.arm_start).norm(), 2e-3);
  });
  ASSERT_EQ(times.size(), 26u);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(times[i], 0.02 * static_cast<double>(i), 1e-12);
  }
}

TEST(RunHeadless, EndsWhenTheRobotHasFallen) {
  WorldParams config = folded_arm();
  config.arm_mode = ArmMode::kCompliant;
  World world(robot_urdf(), config);
  world.apply_hand_wrench(Eigen::Vector3d(0.0, 600.0, 0.0), Eigen::Vector3d::Zero());
  int after_the_fall = 0;
  run_headless(world, 5.0, 100, [&](World& now) { after_the_fall += now.fallen() ? 1 : 0; });
  EXPECT_EQ(after_the_fall, 1);
  EXPECT_LT(world.time(), 5.0);
}

TEST(RunHeadless, RefusesDurationsAndRatesOutOfBounds) {
  World world(robot_urdf(), folded_arm());
  const auto nothing = [](World&) {};
  for (const double duration : {-1.0, 1e6, std::nan("")}) {
    EXPECT_THROW(run_headless(world, duration, 100, nothing), std::invalid_argument) << duration;
  }
  for (const int rate : {0, -1, 3, 2000}) {
    EXPECT_THROW(run_headless(world, 1.0, rate, nothing), std::invalid_argument) << rate;
  }
}

}  // namespace
}  // namespace platform_sim
