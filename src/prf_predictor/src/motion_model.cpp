// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/motion_model.hpp"

#include <algorithm>
#include <cmath>

#include "require.hpp"

namespace prf_predictor {

double VelocityDecay::velocity_factor(double dt) const { return std::exp(-dt / time_constant); }

double VelocityDecay::travel(double dt) const {
  return std::isinf(time_constant) ? dt : -time_constant * std::expm1(-dt / time_constant);
}

Eigen::Matrix2d VelocityDecay::noise(double dt) const {
  const double T = time_constant;
  const double b = travel(dt);
  // Below kSmall the closed forms lose their digits to cancellation, above it the series are off.
  constexpr double kSmall = 1e-3;
  const double ratio = dt / T;
  Eigen::Matrix2d Q;
  if (ratio < kSmall) {
    Q(0, 0) = dt * dt * dt * (1.0 / 3.0 - ratio / 4.0);
    Q(1, 1) = dt * (1.0 - ratio);
  } else {
    Q(1, 1) = -0.5 * T * std::expm1(-2.0 * ratio);
    Q(0, 0) = T * T * (dt - 2.0 * b + Q(1, 1));
  }
  Q(0, 1) = Q(1, 0) = 0.5 * b * b;
  return spectral_density * Q;
}

double VelocityDecay::prior_variance() const {
  return std::min(1.0, 0.5 * spectral_density * time_constant);
}

void validate(const VelocityDecay& decay, const std::string& density) {
  require(decay.spectral_density > 0 && std::isfinite(decay.spectral_density), density,
          decay.spectral_density, "finite and > 0");
  require(decay.time_constant > 0, "velocity_time_constant", decay.time_constant, "> 0 s");
}

DecayingVelocity::DecayingVelocity(const VelocityDecay& decay) : decay_(decay) {
  validate(decay, "acceleration_density");
}

Eigen::VectorXd DecayingVelocity::advance(const Eigen::VectorXd& state, double dt) const {
  Eigen::VectorXd next(6);
  next.head<3>() = state.head<3>() + decay_.travel(dt) * state.tail<3>();
  next.tail<3>() = decay_.velocity_factor(dt) * state.tail<3>();
  return next;
}

Eigen::MatrixXd DecayingVelocity::process_noise(double dt) const {
  return for_three_axes(decay_.noise(dt));
}

Eigen::MatrixXd DecayingVelocity::prior_covariance() const {
  return decay_.prior_variance() * Eigen::Matrix3d::Identity();
}

Eigen::Matrix<double, 6, 6> for_three_axes(const Eigen::Matrix2d& noise) {
  Eigen::Matrix<double, 6, 6> Q;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      Q.block<3, 3>(3 * row, 3 * column) = noise(row, column) * Eigen::Matrix3d::Identity();
    }
  }
  return Q;
}

}  // namespace prf_predictor
