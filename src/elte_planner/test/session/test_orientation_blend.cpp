// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/orientation_blend.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace elte_planner {
namespace {

using Orientations = std::vector<Eigen::Quaterniond>;

Eigen::Quaterniond turned(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

Orientations demonstrated(std::size_t nodes) {
  Orientations result;
  for (std::size_t k = 0; k < nodes; ++k) {
    result.push_back(turned(0.04 * static_cast<double>(k), {1.0, 0.3, -0.2}));
  }
  return result;
}

TEST(OrientationBlend, EndsAtTheGoalAndKeepsFrozenNodes) {
  const Orientations start = demonstrated(50);
  const Eigen::Quaterniond goal = turned(0.4, {0.0, 1.0, 0.0}) * start.back();
  for (const Eigen::Index frozen : {1, 2, 25, 49, 50}) {
    const Orientations result = blend_orientations(start, start, frozen, {goal});
    for (std::size_t k = 0; k < static_cast<std::size_t>(frozen); ++k) {
      EXPECT_EQ(result[k].coeffs(), start[k].coeffs());
    }
    const Eigen::Quaterniond& end = frozen < 50 ? goal : start.back();
    EXPECT_LT(result.back().angularDistance(end), 1e-12);
  }
}

TEST(OrientationBlend, IsContinuousAtTheCursor) {
  const Orientations start = demonstrated(50);
  const Orientations first =
      blend_orientations(start, start, 2, {turned(0.5, {0.0, 0.0, 1.0}) * start.back()});
  const Orientations second =
      blend_orientations(start, first, 20, {turned(0.5, {0.0, 1.0, 0.0}) * start.back()});
  for (std::size_t k = 1; k < 50; ++k) {
    EXPECT_LT(second[k].angularDistance(second[k - 1]), 0.04 + 1.2 / 30.0) << "node " << k;
    EXPECT_GE(second[k].dot(second[k - 1]), 0.0);
    EXPECT_NEAR(second[k].norm(), 1.0, 1e-14);
  }
}

TEST(OrientationBlend, ChangesNothingWhenPlannedAgainLater) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Orientations start = demonstrated(50);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond goal =
        turned(0.8 * normal(random), {normal(random), normal(random), normal(random)}) *
        start.back();
    const Orientations first = blend_orientations(start, start, 5, {goal});
    const Orientations again = blend_orientations(start, first, 30, {goal});
    for (std::size_t k = 0; k < 50; ++k) {
      ASSERT_LT(first[k].angularDistance(again[k]), 1e-7) << "problem " << i << ", node " << k;
    }
  }
}

TEST(OrientationBlend, KeepsTheDemonstrationWhenTheGoalIsDemonstrated) {
  const Orientations start = demonstrated(20);
  Eigen::Quaterniond opposite = start.back();
  opposite.coeffs() = -opposite.coeffs();
  for (const Eigen::Quaterniond& goal : {start.back(), opposite}) {
    const Orientations result = blend_orientations(start, start, 3, {goal});
    for (std::size_t k = 0; k < 20; ++k) {
      EXPECT_LT(result[k].angularDistance(start[k]), 1e-7);
    }
  }
}

TEST(OrientationBlend, RefusesSizesThatDoNotFit) {
  const Orientations start = demonstrated(10);
  EXPECT_THROW((void)blend_orientations(start, demonstrated(9), 2, {start.back()}),
               std::invalid_argument);
  EXPECT_THROW((void)blend_orientations(start, start, 0, {start.back()}), std::invalid_argument);
  EXPECT_THROW((void)blend_orientations(start, start, 11, {start.back()}), std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
