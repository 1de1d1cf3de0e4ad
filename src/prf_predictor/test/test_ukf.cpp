// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/ukf.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>

namespace prf_predictor {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Eigen::Vector3d normal_vector(std::mt19937& random, double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

Eigen::Matrix3d random_covariance(std::mt19937& random) {
  Eigen::Matrix3d A;
  for (int i = 0; i < 3; ++i) A.col(i) = normal_vector(random, 1e-3);
  return A * A.transpose() + 1e-8 * Eigen::Matrix3d::Identity();
}

// The textbook filter, in Joseph's form, for position and velocity of a constant-velocity model.
struct LinearKalmanFilter {
  Eigen::Matrix<double, 6, 1> x;
  Matrix6d P;

  void predict(double dt, const Matrix6d& Q) {
    Matrix6d F = Matrix6d::Identity();
    F.topRightCorner<3, 3>() = dt * Eigen::Matrix3d::Identity();
    x = F * x;
    P = F * P * F.transpose() + Q;
  }
  void correct(const Eigen::Vector3d& z, const Eigen::Matrix3d& R) {
    Eigen::Matrix<double, 3, 6> H = Eigen::Matrix<double, 3, 6>::Zero();
    H.leftCols<3>().setIdentity();
    const Eigen::Matrix3d S = H * P * H.transpose() + R;
    const Eigen::Matrix<double, 6, 3> K = S.ldlt().solve(H * P).transpose();
    x += K * (z - H * x);
    const Matrix6d I_KH = Matrix6d::Identity() - K * H;
    P = I_KH * P * I_KH.transpose() + K * R * K.transpose();
  }
};

class UkfOnLinearModel : public ::testing::TestWithParam<SigmaPointParams> {};

TEST_P(UkfOnLinearModel, EqualsTheKalmanFilter) {
  const VelocityDecay decay{0.3, kInfinity};
  const DecayingVelocity model(decay);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> step(0.005, 0.2);
  const Eigen::Matrix3d R0 = random_covariance(random);
  Gaussian belief = model.initial_belief({0.8, -0.1, 0.4}, R0);
  LinearKalmanFilter reference{belief.mean, belief.covariance};
  for (int i = 0; i < 300; ++i) {
    const double dt = step(random);
    const Eigen::Vector3d z = Eigen::Vector3d(0.8, -0.1, 0.4) + normal_vector(random, 0.01);
    const Eigen::Matrix3d R = random_covariance(random);
    belief = predict(belief, model, dt, GetParam());
    reference.predict(dt, for_three_axes(decay.noise(dt)));
    belief = correct(belief, innovate(belief, z, R));
    reference.correct(z, R);
    ASSERT_LT((belief.mean - reference.x).cwiseAbs().maxCoeff(), 1e-12) << "step " << i;
    ASSERT_LT((belief.covariance - reference.P).cwiseAbs().maxCoeff(), 1e-12) << "step " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, UkfOnLinearModel,
                         ::testing::Values(SigmaPointParams::textbook(), SigmaPointParams::paper(),
                                           SigmaPointParams{1.0, 2.0, 0.0},
                                           SigmaPointParams{0.5, 2.0, 1.0}));

TEST(Ukf, CovarianceStaysPositiveDefiniteThroughDropoutsAndExtremes) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int run = 0; run < 40; ++run) {
    const DecayingVelocity model({std::pow(10.0, -4 + 6 * uniform(random)), 0.6});
    const auto params = run % 2 == 0 ? SigmaPointParams::paper() : SigmaPointParams::textbook();
    Gaussian belief = model.initial_belief({1, 0, 0}, random_covariance(random));
    for (int i = 0; i < 200; ++i) {
      belief = predict(belief, model, std::pow(10.0, -4 + 5 * uniform(random)), params);
      if (uniform(random) < 0.6) {
        const Eigen::Matrix3d R =
            random_covariance(random) * std::pow(10.0, -6 + 8 * uniform(random));
        belief = correct(belief, innovate(belief, normal_vector(random, 1.0), R));
      }
      ASSERT_TRUE(is_finite(belief));
      ASSERT_EQ(belief.covariance, belief.covariance.transpose());
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(belief.covariance);
      ASSERT_GT(eigen.eigenvalues().minCoeff(), -1e-12 * eigen.eigenvalues().maxCoeff());
    }
  }
}

TEST(Ukf, NisIsConsistentOnDataDrawnFromTheModel) {
  const VelocityDecay decay{0.3, 0.6};
  const DecayingVelocity model(decay);
  const auto params = SigmaPointParams::textbook();
  const double dt = 1.0 / 30;
  const Eigen::Matrix3d R = Eigen::Vector3d(1e-6, 4e-6, 9e-6).asDiagonal();
  const Eigen::Matrix3d R_root = Eigen::Vector3d(1e-3, 2e-3, 3e-3).asDiagonal();
  const Eigen::MatrixXd Q_root = model.process_noise(dt).llt().matrixL();
  std::mt19937 random(8);
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(6);
  truth.tail<3>() = std::sqrt(decay.prior_variance()) * normal_vector(random, 1.0);
  Gaussian belief = model.initial_belief(R_root * normal_vector(random, 1.0), R);
  double sum = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i) {
    Eigen::VectorXd noise(6);
    noise << normal_vector(random, 1.0), normal_vector(random, 1.0);
    truth = model.advance(truth, dt) + Q_root * noise;
    belief = predict(belief, model, dt, params);
    const Eigen::Vector3d z = truth.head<3>() + R_root * normal_vector(random, 1.0);
    const Innovation innovation = innovate(belief, z, R);
    sum += innovation.nis;
    belief = correct(belief, innovation);
  }
  // 95 % of chi-square with 3000 degrees of freedom, normal approximation.
  const double freedom = 3.0 * kSteps;
  EXPECT_NEAR(sum, freedom, 1.96 * std::sqrt(2 * freedom));
}

// Of x^2 with x ~ N(m, s^2): mean m^2 + s^2, variance 4 m^2 s^2 + 2 s^4; exact for beta = 2.
TEST(UnscentedTransform, IsExactForASquare) {
  const double m = 0.7;
  const double s = 0.4;
  const Gaussian x{Eigen::VectorXd::Constant(1, m), Eigen::MatrixXd::Constant(1, 1, s * s)};
  const auto square = [](const Points& values) -> Points { return values.cwiseProduct(values); };
  const auto transformed = unscented_transform(x, SigmaPointParams{1.0, 2.0, 0.0}, square);
  EXPECT_NEAR(transformed.mean(0), m * m + s * s, 1e-14);
  EXPECT_NEAR(transformed.covariance(0, 0), 4 * m * m * s * s + 2 * std::pow(s, 4), 1e-14);
}

TEST(UnscentedTransform, UsesTheGivenMeanAndResidualForAngles) {
  Gaussian heading{State::Constant(1, M_PI - 0.05), StateMatrix::Constant(1, 1, 0.04)};
  const auto wrap = [](double angle) { return std::remainder(angle, 2 * M_PI); };
  const auto transformed = unscented_transform(
      heading, SigmaPointParams{1.0, 0.0, 0.0},
      [&](const Points& x) -> Points { return (x.array() + 0.1).unaryExpr(wrap); },
      [&](const Points& points, const Weights& weights) -> State {
        const Eigen::ArrayXd angles = points.row(0).transpose().array();
        return State::Constant(1, std::atan2((weights.array() * angles.sin()).sum(),
                                             (weights.array() * angles.cos()).sum()));
      },
      [&](const Points& points, const State& mean) -> Points {
        return (points.array() - mean(0)).unaryExpr(wrap);
      });
  EXPECT_NEAR(transformed.mean(0), wrap(M_PI + 0.05), 1e-12);
  EXPECT_NEAR(transformed.covariance(0, 0), 0.04, 1e-12);
}

// What innovate() does without it.
TEST(UnscentedTransform, GivesThePositionExactly) {
  const Oscillation model({0.03, 1e-4, 0.01});
  std::mt19937 random(6);
  const Eigen::Matrix3d R = random_covariance(random);
  for (const auto& params : {SigmaPointParams::paper(), SigmaPointParams::textbook()}) {
    const Gaussian belief = predict(model.initial_belief({0.8, -0.1, 0.4}, R), model, 0.5, params);
    const Gaussian position = unscented_transform(
        belief, params, [](const Points& states) -> Points { return states.topRows<3>(); });
    const Innovation innovation = innovate(belief, {0.0, 0.0, 0.0}, R);
    EXPECT_LT((position.mean + innovation.residual).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((position.covariance + R - innovation.covariance).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(SigmaPointParams, AreRefusedOutOfBounds) {
  EXPECT_NO_THROW(SigmaPointParams::paper().validate());
  EXPECT_NO_THROW(SigmaPointParams::textbook().validate());
  for (const SigmaPointParams& bad :
       {SigmaPointParams{0, 2, 0}, {1.1, 2, 0}, {NAN, 2, 0}, {1, -1, 0}, {1, 2, -1}, {1, 2, NAN}}) {
    EXPECT_THROW(bad.validate(), std::invalid_argument);
  }
}

}  // namespace
}  // namespace prf_predictor
