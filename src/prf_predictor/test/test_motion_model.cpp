// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/motion_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace prf_predictor {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(VelocityDecay, ComposesOverTime) {
  for (const double T : {0.3, 5.0, 1e3, kInfinity}) {
    const VelocityDecay decay{0.7, T};
    for (const double dt : {1e-3, 0.03, 0.4}) {
      const double a = decay.velocity_factor(dt);
      const double b = decay.travel(dt);
      EXPECT_NEAR(decay.velocity_factor(2 * dt), a * a, 1e-14);
      EXPECT_NEAR(decay.travel(2 * dt), b + a * b, 1e-14);
      const Eigen::Matrix2d F = (Eigen::Matrix2d() << 1, b, 0, a).finished();
      const Eigen::Matrix2d Q = decay.noise(dt);
      const Eigen::Matrix2d twice = F * Q * F.transpose() + Q;
      EXPECT_LT((decay.noise(2 * dt) - twice).norm(), 1e-6 * twice.norm()) << T << " " << dt;
    }
  }
}

TEST(VelocityDecay, NoiseIsPositiveDefiniteAndTendsToConstantVelocity) {
  for (const double T : {0.1, 0.6, 100.0, 1e6, kInfinity}) {
    for (const double dt : {1e-4, 1e-2, 1.0, 10.0}) {
      const Eigen::Matrix2d Q = VelocityDecay{1.0, T}.noise(dt);
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(Q).eigenvalues().minCoeff(), 0)
          << T << " " << dt;
    }
  }
  const double dt = 0.1;
  const Eigen::Matrix2d Q = VelocityDecay{2.0, kInfinity}.noise(dt);
  EXPECT_NEAR(Q(0, 0), 2.0 * dt * dt * dt / 3, 1e-18);
  EXPECT_NEAR(Q(0, 1), 2.0 * dt * dt / 2, 1e-18);
  EXPECT_NEAR(Q(1, 1), 2.0 * dt, 1e-18);
}

TEST(DecayingVelocity, KeepsVelocityWhenItsTimeConstantIsInfinite) {
  const DecayingVelocity model({1.0, kInfinity});
  Eigen::VectorXd state(6);
  state << 1, 2, 3, 0.1, -0.2, 0.3;
  const Eigen::VectorXd next = model.advance(state, 2.0);
  EXPECT_EQ(next.tail<3>(), state.tail<3>());
  EXPECT_EQ(next.head<3>(), state.head<3>() + 2.0 * state.tail<3>());
}

std::vector<std::shared_ptr<const MotionModel>> all_models() {
  return {std::make_shared<DecayingVelocity>(VelocityDecay{0.3, 0.6}),
          std::make_shared<ConstantAcceleration>(2.0),
          std::make_shared<Oscillation>(OscillationNoise{0.3, 1e-4, 1e-2})};
}

Eigen::VectorXd state_of(const MotionModel& model) {
  const Eigen::VectorXd state = Eigen::VectorXd::LinSpaced(model.dimension(), -0.4, 0.9);
  return state;
}

TEST(MotionModel, JacobianIsTheDerivativeOfAdvance) {
  for (const auto& model : all_models()) {
    const Eigen::VectorXd state = state_of(*model);
    const Eigen::MatrixXd F = model->jacobian(state, 0.7);
    for (Eigen::Index i = 0; i < state.size(); ++i) {
      const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(state.size(), i);
      const Eigen::VectorXd difference =
          (model->advance(state + step, 0.7) - model->advance(state - step, 0.7)) / 2e-6;
      EXPECT_LT((F.col(i) - difference).norm(), 1e-8) << state.size() << " " << i;
    }
  }
}

TEST(MotionModel, AdvancesTwiceAsFarInTwoSteps) {
  for (const auto& model : all_models()) {
    const Eigen::VectorXd state = state_of(*model);
    const Eigen::VectorXd twice = model->advance(model->advance(state, 0.3), 0.3);
    EXPECT_LT((twice - model->advance(state, 0.6)).norm(), 1e-13) << state.size();
  }
}

TEST(ConstantAcceleration, NoiseComposesOverTime) {
  const ConstantAcceleration model(2.0);
  const Eigen::MatrixXd F = model.jacobian(Eigen::VectorXd(9), 0.2);
  const Eigen::MatrixXd Q = model.process_noise(0.2);
  EXPECT_LT((model.process_noise(0.4) - (F * Q * F.transpose() + Q)).norm(), 1e-15);
}

TEST(DecayingVelocity, RefusesParametersOutOfBounds) {
  for (const VelocityDecay& bad :
       {VelocityDecay{0, 1}, {-1, 1}, {NAN, 1}, {kInfinity, 1}, {1, 0}, {1, -1}, {1, NAN}}) {
    EXPECT_THROW(DecayingVelocity{bad}, std::invalid_argument);
  }
  EXPECT_THROW(ConstantAcceleration{0.0}, std::invalid_argument);
  for (const OscillationNoise& bad : {OscillationNoise{0, 1, 1}, {1, NAN, 1}, {1, 1, -1}}) {
    EXPECT_THROW(Oscillation{bad}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace prf_predictor
