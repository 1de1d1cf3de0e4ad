// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/elte_energy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "random_problems.hpp"

namespace elte_planner {
namespace {

TEST(EnergyGradient, IsTheDerivativeOfTheEnergy) {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    const auto nodes = std::uniform_int_distribution<Eigen::Index>(3, 12)(random);
    const Eigen::MatrixXd zeta = random_demonstration(nodes, 2, random);
    const ElteWeights weights = random_weights(random);
    Eigen::MatrixXd y = zeta;
    for (Eigen::Index k = 0; k < nodes; ++k) y.row(k) += random_vector(2, 0.1, random).transpose();
    for (Eigen::Index k = 0; k < nodes; ++k) {
      // The energy is quadratic: the central difference is exact but for rounding.
      const double step = 0.5;
      Eigen::MatrixXd plus = y;
      Eigen::MatrixXd minus = y;
      plus(k, 1) += step;
      minus(k, 1) -= step;
      const double expected =
          (energy(zeta, weights, plus) - energy(zeta, weights, minus)) / (4.0 * step);
      ASSERT_NEAR(half_gradient(zeta, weights, y, k, 1), expected,
                  1e-12 * (1.0 + weights.elastic + weights.bending));
    }
  }
}

TEST(EnergyGradient, VanishesOnTheDemonstrationWithoutPenalties) {
  std::mt19937 random(2);
  const Eigen::MatrixXd zeta = random_demonstration(30, 3, random);
  for (const Laplacian laplacian : {Laplacian::kFreeEnds, Laplacian::kRowNormalised}) {
    const ElteWeights weights{0.0, 0.0, laplacian};
    EXPECT_NEAR(energy(zeta, weights, zeta), 0.0, 1e-28);
    for (Eigen::Index k = 0; k < 30; ++k) {
      EXPECT_NEAR(half_gradient(zeta, weights, zeta, k, 0), 0.0, 1e-15);
    }
  }
}

TEST(L1Projection, IsTheNearestPointOfTheBall) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 3000; ++i) {
    const auto size = std::uniform_int_distribution<Eigen::Index>(1, 8)(random);
    const Eigen::VectorXd centre = random_vector(size, 1.0, random);
    const Eigen::VectorXd point = random_vector(size, 1.0, random);
    const double radius = std::abs(uniform(random));
    Eigen::VectorXd nearest = point;
    project_on_l1_ball(centre, radius, nearest);
    ASSERT_LE((nearest - centre).lpNorm<1>(), radius + 1e-14);
    // Variational inequality of the projection against points of the ball.
    for (int trial = 0; trial < 20; ++trial) {
      Eigen::VectorXd other = Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random); });
      other = centre + other * (radius / other.lpNorm<1>());
      ASSERT_LE((point - nearest).dot(other - nearest), 1e-12);
    }
  }
}

TEST(L1Projection, LeavesPointsOfTheBallAlone) {
  const Eigen::Vector3d centre(1.0, 2.0, 3.0);
  Eigen::VectorXd point = centre + Eigen::Vector3d(0.1, -0.2, 0.1);
  const Eigen::VectorXd before = point;
  project_on_l1_ball(centre, 0.5, point);
  EXPECT_EQ(point, before);
  project_on_l1_ball(centre, 0.0, point);
  EXPECT_EQ(point, centre);
}

TEST(ShapeLoss, GrowsWithTheNumberOfNodesAtOneWeight) {
  std::mt19937 random(4);
  const ElteWeights weights;
  const auto arc = [](Eigen::Index nodes) {
    Eigen::MatrixXd zeta(nodes, 2);
    for (Eigen::Index k = 0; k < nodes; ++k) {
      const double angle = M_PI * static_cast<double>(k) / static_cast<double>(nodes - 1);
      zeta.row(k) << std::cos(angle), std::sin(angle);
    }
    return zeta;
  };
  EXPECT_LT(shape_loss(arc(50), weights), 0.5);
  EXPECT_GT(shape_loss(arc(1000), weights), 0.8);
  EXPECT_LT(shape_loss(arc(50), {0.0, 0.0, Laplacian::kFreeEnds}), 1e-9);
}

TEST(ShapeLoss, IsZeroForAStraightDemonstration) {
  Eigen::MatrixXd line(100, 3);
  for (Eigen::Index k = 0; k < 100; ++k) line.row(k).setConstant(0.01 * static_cast<double>(k * k));
  EXPECT_EQ(shape_loss(line, {}), 0.0);
}

TEST(ElteWeights, RefuseWhatIsOutOfRange) {
  for (const double bad : {-1e-9, std::nan(""), HUGE_VAL, 1e7}) {
    EXPECT_THROW((ElteWeights{bad, 0.0, Laplacian::kFreeEnds}.validate()), std::invalid_argument);
    EXPECT_THROW((ElteWeights{0.0, bad, Laplacian::kFreeEnds}.validate()), std::invalid_argument);
  }
  EXPECT_NEAR(ElteWeights{}.decay_nodes(), std::sqrt(251.0), 1e-9);
}

}  // namespace
}  // namespace elte_planner
