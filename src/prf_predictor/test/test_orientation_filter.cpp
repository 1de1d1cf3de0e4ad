// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/orientation_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace prf_predictor {
namespace {

const VelocityDecay kSteady{0.3, std::numeric_limits<double>::infinity()};

Eigen::Vector3d normal_vector(std::mt19937& random, double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

TEST(OrientationFilter, RotationVectorsRoundTrip) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    Eigen::Vector3d v = normal_vector(random, 1.0);
    if (v.norm() > 3.1) v *= 3.1 / v.norm();
    EXPECT_LT((rotation_vector(rotation_of(v)) - v).norm(), 1e-12);
    Eigen::Quaterniond opposite = rotation_of(v);
    opposite.coeffs() *= -1;
    EXPECT_LT((rotation_vector(opposite) - v).norm(), 1e-12);
  }
  EXPECT_EQ(rotation_vector(Eigen::Quaterniond::Identity()).norm(), 0);
}

TEST(OrientationFilter, FindsAConstantRateAndForecastsIt) {
  const Eigen::Vector3d rate(0.1, -0.3, 0.2);
  const Eigen::Quaterniond start = rotation_of({0.3, 2.0, -1.0});
  const Eigen::Matrix3d R = 1e-6 * Eigen::Matrix3d::Identity();
  std::mt19937 random(3);
  auto belief = initial_orientation(kSteady, start, R);
  const double dt = 1.0 / 30;
  int k = 1;
  for (; k <= 300; ++k) {
    const Eigen::Quaterniond truth = rotation_of(rate * dt * k) * start;
    belief = predict(belief, kSteady, dt);
    belief = correct(belief, innovate(belief, rotation_of(normal_vector(random, 1e-3)) * truth, R));
  }
  EXPECT_LT((belief.rate - rate).norm(), 0.1);
  const auto ahead = predict(belief, kSteady, 0.5);
  const Eigen::Quaterniond truth = rotation_of(rate * (dt * (k - 1) + 0.5)) * start;
  EXPECT_LT(rotation_vector(ahead.orientation * truth.conjugate()).norm(), 0.05);
}

// Errors drawn from the belief and carried through the true motion must match the prediction.
TEST(OrientationFilter, PredictedCovarianceMatchesSampledErrors) {
  OrientationBelief belief;
  belief.orientation = rotation_of({0.2, -1.0, 0.4});
  belief.rate = {0.8, -0.5, 1.5};
  belief.covariance.diagonal() << 4e-4, 1e-4, 2e-4, 9e-4, 1e-4, 4e-4;
  const VelocityDecay quiet{1e-12, 0.6};
  const double dt = 0.7;
  const auto predicted = predict(belief, quiet, dt);
  std::mt19937 random(9);
  Eigen::Matrix<double, 6, 6> sampled = Eigen::Matrix<double, 6, 6>::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    Eigen::Matrix<double, 6, 1> error;
    error << normal_vector(random, 1.0), normal_vector(random, 1.0);
    error = belief.covariance.diagonal().cwiseSqrt().cwiseProduct(error);
    OrientationBelief truth = belief;
    truth.orientation = rotation_of(error.head<3>()) * belief.orientation;
    truth.rate += error.tail<3>();
    truth = predict(truth, quiet, dt);
    Eigen::Matrix<double, 6, 1> after;
    after << rotation_vector(truth.orientation * predicted.orientation.conjugate()),
        truth.rate - predicted.rate;
    sampled += after * after.transpose() / kSamples;
  }
  EXPECT_LT((sampled - predicted.covariance).norm(), 0.03 * predicted.covariance.norm());
}

TEST(OrientationFilter, CorrectionShrinksErrorAndCovariance) {
  const Eigen::Quaterniond truth = rotation_of({1.0, 0.5, 2.0});
  auto belief = initial_orientation(kSteady, rotation_of({0.05, 0.02, -0.04}) * truth,
                                    1e-2 * Eigen::Matrix3d::Identity());
  const auto after = correct(belief, innovate(belief, truth, 1e-6 * Eigen::Matrix3d::Identity()));
  EXPECT_LT(rotation_vector(after.orientation * truth.conjugate()).norm(), 1e-4);
  EXPECT_LT(after.covariance.trace(), belief.covariance.trace());
}

}  // namespace
}  // namespace prf_predictor

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
