// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/combine_demonstrations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "elte_planner/elte_energy.hpp"
#include "random_problems.hpp"

namespace elte_planner {
namespace {

// Along an arch that is `height` high.
Demonstration arch(double height) {
  std::vector<TimedPose> samples;
  for (int i = 0; i <= 200; ++i) {
    const double s = i / 200.0;
    const Eigen::AngleAxisd turn(0.5 * height * s, Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d position(s, height * std::sin(M_PI * s), 0.0);
    samples.push_back({0.01 * i, {position, Eigen::Quaterniond(turn)}});
  }
  return Demonstration(samples, "arm", "hand", Pose{});
}

Demonstration in_place_of(const Demonstration& d, const Pose& target) {
  const Eigen::Isometry3d motion = target.isometry() * d.target().isometry().inverse();
  std::vector<TimedPose> samples = d.samples();
  for (TimedPose& sample : samples)
    sample.pose = prf_core::pose_from(motion * sample.pose.isometry());
  return Demonstration(samples, "arm", "hand", target);
}

TEST(Combined, MeanHasTheLaplacianEnergyOfAllUpToAConstant) {
  const std::vector<Demonstration> all = {arch(0.2), arch(0.5), arch(0.3)};
  constexpr Eigen::Index kNodes = 40;
  const Demonstration mean = combined(all, kNodes, Alignment::kArcLength);
  const ElteWeights shape_only{0.0, 0.0, Laplacian::kRowNormalised};
  std::mt19937 random(1);
  double constant = 0.0;
  for (int i = 0; i < 20; ++i) {
    const Eigen::MatrixXd y = random_demonstration(kNodes, 3, random);
    double sum = 0.0;
    for (const Demonstration& d : all) {
      sum += energy(d.resampled_by_arc_length(kNodes).positions(), shape_only, y);
    }
    const double difference = sum - 3.0 * energy(mean.positions(), shape_only, y);
    if (i == 0) constant = difference;
    ASSERT_NEAR(difference, constant, 1e-12);
  }
  EXPECT_GT(constant, 1e-6);
}

TEST(Combined, OfOneDemonstrationIsItsResampling) {
  for (const Alignment alignment : {Alignment::kArcLength, Alignment::kDynamicTimeWarping}) {
    const Demonstration one = combined({arch(0.3)}, 30, alignment);
    const Demonstration expected = arch(0.3).resampled_by_arc_length(30);
    EXPECT_LE((one.positions() - expected.positions()).cwiseAbs().maxCoeff(), 1e-14);
    for (std::size_t k = 0; k < 30; ++k) {
      EXPECT_NEAR(one.samples()[k].time, expected.samples()[k].time, 1e-14);
    }
  }
}

TEST(Combined, LiesBetweenTheDemonstrationsInPlaceTurnAndTime) {
  const Demonstration mean = combined({arch(0.2), arch(0.4)}, 50, Alignment::kArcLength);
  EXPECT_NEAR(mean.positions().col(1).maxCoeff(), 0.3, 0.005);
  EXPECT_NEAR(mean.samples().back().time, 2.0, 1e-12);
  const Eigen::AngleAxisd last(mean.samples().back().pose.orientation);
  EXPECT_NEAR(last.angle(), 0.15, 1e-12);
}

TEST(Combined, IsTakenRelativeToTheTarget) {
  Pose elsewhere;
  elsewhere.position << 3.0, -1.0, 0.5;
  elsewhere.orientation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized());
  const Demonstration there = in_place_of(arch(0.3), elsewhere);
  const Demonstration mean = combined({arch(0.3), there}, 30, Alignment::kArcLength);
  const Demonstration expected = arch(0.3).resampled_by_arc_length(30);
  EXPECT_LE((mean.positions() - expected.positions()).cwiseAbs().maxCoeff(), 1e-12);
}

// From their matrices, the two turns get quaternions of opposite signs.
TEST(Combined, TurnsWhoseQuaternionsHaveOppositeSignsMeetBetween) {
  const auto turned = [](double angle) {
    std::vector<TimedPose> samples = arch(0.3).samples();
    for (TimedPose& sample : samples) {
      sample.pose.orientation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
    }
    return Demonstration(samples, "arm", "hand", Pose{});
  };
  const Demonstration mean = combined({turned(-2.05), turned(-2.15)}, 30, Alignment::kArcLength);
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(-2.1, Eigen::Vector3d::UnitZ()));
  for (const TimedPose& sample : mean.samples()) {
    EXPECT_NEAR(sample.pose.orientation.angularDistance(expected), 0.0, 1e-7);
  }
}

// The second demonstration wanders before it follows the first: arc length shifts all of its nodes.
TEST(Combined, WarpingMatchesPlacesWhereArcLengthDoesNot) {
  std::vector<TimedPose> samples;
  for (int i = 0; i <= 50; ++i) {
    samples.push_back({0.01 * i,
                       {Eigen::Vector3d(0.0, 0.0, 0.3 * std::sin(M_PI * i / 50.0)),
                        Eigen::Quaterniond::Identity()}});
  }
  const Demonstration direct = arch(0.3);
  for (const TimedPose& sample : direct.samples()) {
    samples.push_back({0.51 + sample.time, sample.pose});
  }
  const Demonstration detour(samples, "arm", "hand", Pose{});
  const auto middle_error = [&](Alignment alignment) {
    const Eigen::MatrixXd mean = combined({arch(0.3), detour}, 60, alignment).positions();
    const Eigen::MatrixXd expected = arch(0.3).resampled_by_arc_length(60).positions();
    return (mean - expected).middleRows(20, 20).rowwise().norm().maxCoeff();
  };
  EXPECT_LT(middle_error(Alignment::kDynamicTimeWarping), 0.02);
  EXPECT_GT(middle_error(Alignment::kArcLength), 0.1);
}

TEST(Combined, NothingOrDifferentFramesAreRefused) {
  EXPECT_THROW((void)combined({}, 30, Alignment::kArcLength), std::invalid_argument);
  const Demonstration other(arch(0.3).samples(), "world", "hand", Pose{});
  EXPECT_THROW((void)combined({arch(0.3), other}, 30, Alignment::kArcLength),
               std::invalid_argument);
  EXPECT_THROW((void)combined({arch(0.3)}, 2, Alignment::kArcLength), std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
