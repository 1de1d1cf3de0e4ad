// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "temporary_file.hpp"
#include "v60_world.hpp"

namespace platform_sim {
namespace {

TEST(World, CarriesTheBaseThroughTheMotionThatIsPrinted) {
  WorldParams config = folded_arm();
  config.motion = "as_printed";
  World world(robot_urdf(), config);
  const Eigen::Isometry3d start = world.platform().pose.inverse() * world.base().pose;
  double fastest = 0.0;
  for (int period = 0; period < 400; ++period) {
    run(world, 0.01);
    const Eigen::Isometry3d base = world.platform().pose.inverse() * world.base().pose;
    ASSERT_LT((base.translation() - start.translation()).norm(), 1e-5) << world.time();
    ASSERT_LT(Eigen::AngleAxisd(base.linear() * start.linear().transpose()).angle(), 1e-5);
    fastest = std::max(fastest, world.base().linear.norm());
  }
  EXPECT_FALSE(world.fallen());
  EXPECT_NEAR(fastest, 6.28, 0.1);
}

TEST(World, CarriesTheBaseAlongARecordedMotionAndTheArmFeelsIt) {
  std::string text = "time,x,y,z,roll,pitch,yaw\n";
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.01 * i, y = 0.1 * std::sin(3.0 * t);
    text += std::to_string(t) + ",-0.1," + std::to_string(y) + ",0.52,0,0,0.1\n";
  }
  const TemporaryFile file(text, ".csv");
  WorldParams config = folded_arm();
  config.motion = "light";
  config.body_motion = file.path();
  World world(robot_urdf(), config);
  const double still = world.joints().efforts[12];
  double farthest = 0.0, effort = 0.0;
  int compared = 0;
  for (int period = 0; period < 500; ++period) {
    run(world, 0.01);
    const Eigen::Isometry3d base = world.platform().pose.inverse() * world.base().pose;
    // As RecordedMotion plays: the first second rises, 4 s last until the end's turn begins.
    if (world.time() > 1.0 && world.time() < 4.0) {
      const Eigen::Vector3d expected(-0.1, 0.1 * std::sin(3.0 * (world.time() - 0.5)), 0.52);
      ASSERT_LT((base.translation() - expected).norm(), 1e-5) << world.time();
      ++compared;
    }
    farthest = std::max(farthest, std::abs(base.translation().y()));
    effort = std::max(effort, std::abs(world.joints().efforts[12] - still));
    for (const Contact& contact : world.take_contacts()) {
      EXPECT_NE(contact.link_b, "platform") << contact.link_a;
      EXPECT_NE(contact.link_a, "platform") << contact.link_b;
    }
  }
  EXPECT_GT(compared, 290);  // 3 s of ticks
  EXPECT_NEAR(farthest, 0.1, 0.003);
  EXPECT_GT(effort, 0.1);
}

}  // namespace
}  // namespace platform_sim
