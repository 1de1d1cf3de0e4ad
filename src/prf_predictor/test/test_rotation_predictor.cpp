// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/rotation_predictor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <prf_core/se3.hpp>
#include <random>

#include "prf_predictor/kalman_predictor.hpp"

namespace prf_predictor {
namespace {

using prf_core::log_so3;

Eigen::Quaterniond rotation(const Eigen::Vector3d& vector) {
  return Eigen::Quaterniond(prf_core::exp_so3(vector));
}

KalmanPredictor constant_velocity(double density) {
  const VelocityDecay decay{density, std::numeric_limits<double>::infinity()};
  return {std::make_shared<DecayingVelocity>(decay), SigmaPointParams::textbook()};
}

const KalmanPredictor kSteady = constant_velocity(0.3);
const KalmanPredictor kLoose = constant_velocity(1e3);

Eigen::Vector3d normal_vector(std::mt19937& random, double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

TEST(RotationPredictor, FindsAConstantRateAndForecastsItBeyondHalfATurn) {
  const Eigen::Vector3d rate(0.1, -0.4, 0.2);
  const Eigen::Quaterniond start = rotation({0.3, 2.0, -1.0});
  const Eigen::Matrix3d R = 1e-6 * Eigen::Matrix3d::Identity();
  std::mt19937 random(3);
  RotationPredictor target(kSteady, start, R);
  const double dt = 1.0 / 30;
  int k = 1;
  for (; k <= 300; ++k) {
    const Eigen::Quaterniond truth = rotation(rate * dt * k) * start;
    target.advance(dt);
    target.correct(rotation(normal_vector(random, 1e-3)) * truth, R);
  }
  EXPECT_LT((target.forecast(0).angular_velocity - rate).norm(), 0.1);
  const Eigen::Quaterniond truth = rotation(rate * (dt * (k - 1) + 0.5)) * start;
  EXPECT_LT(log_so3(target.forecast(0.5).orientation * truth.conjugate()).norm(), 0.05);
}

// Far from the reference rotation vectors and rotations from the left differ: a rotation that only
// the covariance's long axis explains must stay on that axis.
TEST(RotationPredictor, KeepsCovarianceAndCorrectionInThePlanningFrame) {
  const Eigen::Quaterniond start = rotation({0.3, 2.0, -1.0});
  const Eigen::Quaterniond turned = rotation({0.0, 1.4, 0.0}) * start;
  const Eigen::Matrix3d R = Eigen::Vector3d(1e-2, 1e-6, 1e-6).asDiagonal();
  RotationPredictor target(kLoose, start, 1e-6 * Eigen::Matrix3d::Identity());
  for (int i = 0; i < 5; ++i) {
    target.advance(10.0);
    target.correct(turned, R);
  }
  const OrientationForecast now = target.forecast(0);
  EXPECT_LT(log_so3(now.orientation * turned.conjugate()).norm(), 1e-3);
  EXPECT_GT(now.covariance(0, 0), 1e-3);
  EXPECT_LT(now.covariance(1, 1) + now.covariance(2, 2), 3e-6);
}

TEST(RotationPredictor, CopiesShareNothing) {
  const Eigen::Matrix3d R = 1e-6 * Eigen::Matrix3d::Identity();
  const RotationPredictor before(kSteady, Eigen::Quaterniond::Identity(), R);
  RotationPredictor after(before);
  after.advance(1.0);
  after.correct(rotation({0.1, 0.0, 0.0}), R);
  EXPECT_EQ(before.forecast(0).orientation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

}  // namespace
}  // namespace prf_predictor
