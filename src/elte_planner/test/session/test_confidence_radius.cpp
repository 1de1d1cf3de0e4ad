// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/confidence_radius.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <prf_core/chi_square.hpp>
#include <random>
#include <stdexcept>

namespace elte_planner {
namespace {

Eigen::MatrixXd random_covariance(Eigen::Index size, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
  return root * root.transpose();
}

TEST(ConfidenceRadius, HoldsTheProbabilityAskedFor) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const Eigen::Index size : {1, 2, 3}) {
    for (const double probability : {0.1, 0.5, 0.9, 0.99}) {
      for (int i = 0; i < 5; ++i) {
        const Eigen::MatrixXd covariance = random_covariance(size, random);
        const double radius = confidence_radius(covariance, probability);
        const Eigen::MatrixXd root = covariance.llt().matrixL();
        constexpr int kDraws = 40000;
        int within = 0;
        for (int draw = 0; draw < kDraws; ++draw) {
          const Eigen::VectorXd x =
              root * Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); });
          if (x.lpNorm<1>() <= radius) ++within;
        }
        // Four standard deviations of the count, and the rule's own error.
        const double deviation = std::sqrt(probability * (1.0 - probability) / kDraws);
        ASSERT_NEAR(static_cast<double>(within) / kDraws, probability, 4.0 * deviation + 0.003);
      }
    }
  }
}

TEST(ConfidenceRadius, MatchesClosedForms) {
  // One dimension: 1.959964 standard deviations hold 95 %.
  EXPECT_NEAR(confidence_radius(Eigen::MatrixXd::Constant(1, 1, 0.04), 0.95), 0.2 * 1.959964, 1e-4);
  for (const double p : {0.05, 0.5, 0.999}) {
    const double expected = std::sqrt(prf_core::chi_square_quantile(1, p));
    EXPECT_NEAR(confidence_radius(Eigen::MatrixXd::Ones(1, 1), p), expected, 1e-4 * expected);
  }
  // Two equal dimensions: the ball is a square turned by 45 degrees, P = erf(r / 2 sigma)^2.
  const double radius = confidence_radius(Eigen::Matrix2d::Identity(), 0.8);
  EXPECT_NEAR(std::pow(std::erf(radius / 2.0), 2), 0.8, 1e-3);
}

TEST(ConfidenceRadius, ScalesWithTheStandardDeviation) {
  std::mt19937 random(2);
  const Eigen::MatrixXd covariance = random_covariance(3, random);
  const double one = confidence_radius(covariance, 0.7);
  EXPECT_NEAR(confidence_radius(1e-8 * covariance, 0.7), 1e-4 * one, 1e-7 * one);
  EXPECT_EQ(confidence_radius(Eigen::Matrix3d::Zero(), 0.7), 0.0);
}

TEST(ConfidenceRadius, AcceptsACovarianceOfOneDirection) {
  const Eigen::Vector3d direction(1.0, -2.0, 0.5);
  const Eigen::Matrix3d covariance = direction * direction.transpose();
  // |x|_1 = |t| 3.5 with t normal.
  EXPECT_NEAR(confidence_radius(covariance, 0.95), 3.5 * 1.959964, 0.02);
}

TEST(ConfidenceRadius, ChangesAsLittleAsTheCovariance) {
  // Nearly equal variances: the directions of the axes are then made of rounding.
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3d change = random_covariance(3, random);
    const double one = confidence_radius(Eigen::Matrix3d::Identity() + 1e-9 * change, 0.5);
    const double other =
        confidence_radius(Eigen::Matrix3d::Identity() - 1e-9 * change.transpose(), 0.5);
    ASSERT_NEAR(one, other, 3e-9 * change.norm());
  }
}

TEST(ConfidenceRadius, NeedNotBeFoundAboveWhatIsEnough) {
  std::mt19937 random(4);
  const ConfidenceRadius radius_of(3, 0.5);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d covariance = random_covariance(3, random);
    const double exact = radius_of(covariance);
    for (const double share : {0.01, 0.5, 0.8, 0.99, 1.01, 2.0}) {
      const double found = radius_of(covariance, share * exact);
      ASSERT_LE(found, exact);
      ASSERT_GE(found, std::min(share, 1.0) * exact * (1.0 - 1e-12));
    }
  }
}

TEST(ConfidenceRadius, RefusesWhatIsNoCovarianceOrProbability) {
  const Eigen::Matrix3d good = Eigen::Matrix3d::Identity();
  for (const double bad : {0.0, 1.0, -0.1, 1.1, std::nan("")}) {
    EXPECT_THROW((void)confidence_radius(good, bad), std::invalid_argument);
  }
  Eigen::Matrix3d asymmetric = good;
  asymmetric(0, 1) = 0.5;
  EXPECT_THROW((void)confidence_radius(asymmetric, 0.5), std::invalid_argument);
  EXPECT_THROW((void)confidence_radius(-good, 0.5), std::invalid_argument);
  Eigen::Matrix3d not_finite = good;
  not_finite(2, 2) = std::nan("");
  EXPECT_THROW((void)confidence_radius(not_finite, 0.5), std::invalid_argument);
  EXPECT_THROW((void)confidence_radius(Eigen::MatrixXd::Identity(4, 4), 0.5),
               std::invalid_argument);
  EXPECT_THROW((void)confidence_radius(Eigen::MatrixXd::Identity(2, 3), 0.5),
               std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
