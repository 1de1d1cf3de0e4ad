// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/variation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "v60_world.hpp"

namespace platform_sim {
namespace {

TEST(Variation, IsNothingAtScaleZeroAndTheSameForTheSameSeed) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(Variation::draw(seed, 0.0).text(), Variation{}.text());
    EXPECT_EQ(Variation::draw(seed, 1.0).text(), Variation::draw(seed, 1.0).text());
    EXPECT_NE(Variation::draw(seed, 1.0).text(), Variation::draw(seed + 1, 1.0).text());
  }
}

TEST(Variation, FillsItsSpreadEvenlyAndNeverLeavesIt) {
  const VariationSpread spread;
  constexpr int kDraws = 4000;
  double sum = 0.0, squares = 0.0, widest = 0.0;
  for (int seed = 0; seed < kDraws; ++seed) {
    const Variation drawn = Variation::draw(static_cast<std::uint64_t>(seed), 0.5);
    EXPECT_LE(drawn.box_position.cwiseAbs().maxCoeff(), 0.5 * spread.box_position);
    EXPECT_LE(drawn.robot_position.cwiseAbs().maxCoeff(), 0.5 * spread.robot_position);
    EXPECT_LE(std::abs(drawn.friction_factor - 1.0), 0.5 * spread.friction);
    EXPECT_LE(std::abs(drawn.camera_noise_factor - 1.0), 0.5 * spread.camera_noise);
    const double share = drawn.robot_yaw / (0.5 * spread.robot_yaw);
    sum += share;
    squares += share * share;
    widest = std::max(widest, std::abs(drawn.box_yaw));
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 4.0 * std::sqrt(1.0 / 3.0 / kDraws));
  EXPECT_NEAR(squares / kDraws, 1.0 / 3.0, 0.02);
  EXPECT_NEAR(widest, 0.5 * spread.box_yaw, 0.01 * spread.box_yaw);
}

TEST(Variation, AlwaysGivesAValidWorld) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    WorldParams config = in_world("jaco_v60");
    Variation::draw(seed, 1.0).apply_to(config);
    EXPECT_NO_THROW(config.validate()) << seed;
  }
}

TEST(Variation, RefusesScalesOutOfBounds) {
  for (const double scale : {-0.1, 1.1, std::nan("")}) {
    EXPECT_THROW((void)Variation::draw(1, scale), std::invalid_argument) << scale;
  }
}

}  // namespace
}  // namespace platform_sim
