// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/motion_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <prf_core/require.hpp>

namespace prf_predictor {

using prf_core::require;
using prf_core::require_between;
namespace {

constexpr double kLeastDensity = 1e-12;  // of every noise
constexpr double kMostDensity = 1e6;

}  // namespace

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

void VelocityDecay::validate() const {
  require_between("acceleration_density", spectral_density, kLeastDensity, kMostDensity,
                  "(m/s^2)^2/Hz");
  require((time_constant >= 1e-3 && time_constant <= 1e6) || std::isinf(time_constant) == 1,
          "velocity_time_constant", time_constant, "within [0.001, 1e+06] s or infinite");
}

DecayingVelocity::DecayingVelocity(const VelocityDecay& decay) : decay_(decay) { decay.validate(); }

Points DecayingVelocity::advance(const Points& states, double dt) const {
  Points next(6, states.cols());
  next.topRows<3>() = states.topRows<3>() + decay_.travel(dt) * states.bottomRows<3>();
  next.bottomRows<3>() = decay_.velocity_factor(dt) * states.bottomRows<3>();
  return next;
}

StateMatrix DecayingVelocity::process_noise(double dt) const {
  return for_three_axes(decay_.noise(dt));
}

StateMatrix DecayingVelocity::jacobian(const State& /*state*/, double dt) const {
  StateMatrix F = StateMatrix::Identity(6, 6);
  F.topRightCorner<3, 3>().diagonal().setConstant(decay_.travel(dt));
  F.bottomRightCorner<3, 3>().diagonal().setConstant(decay_.velocity_factor(dt));
  return F;
}

Gaussian DecayingVelocity::initial_belief(const Eigen::Vector3d& position,
                                          const Eigen::Matrix3d& covariance) const {
  Gaussian belief{State::Zero(6), StateMatrix::Zero(6, 6)};
  belief.mean.head<3>() = position;
  belief.covariance.topLeftCorner<3, 3>() = covariance;
  belief.covariance.diagonal().tail<3>().setConstant(decay_.prior_variance());
  return belief;
}

ConstantAcceleration::ConstantAcceleration(double jerk_density) : jerk_density_(jerk_density) {
  require_between("jerk_density", jerk_density, kLeastDensity, kMostDensity, "(m/s^3)^2/Hz");
}

Points ConstantAcceleration::advance(const Points& states, double dt) const {
  Points next = states;
  next.topRows<6>() += dt * states.bottomRows<6>();
  next.topRows<3>() += 0.5 * dt * dt * states.bottomRows<3>();
  return next;
}

StateMatrix ConstantAcceleration::jacobian(const State& /*state*/, double dt) const {
  StateMatrix F = StateMatrix::Identity(9, 9);
  F.diagonal<3>().setConstant(dt);
  F.diagonal<6>().setConstant(0.5 * dt * dt);
  return F;
}

StateMatrix ConstantAcceleration::process_noise(double dt) const {
  Eigen::Matrix3d q;  // of one axis: the integral of g g^T over g = (t^2 / 2, t, 1)
  q << std::pow(dt, 5) / 20, std::pow(dt, 4) / 8, std::pow(dt, 3) / 6,  //
      std::pow(dt, 4) / 8, std::pow(dt, 3) / 3, dt * dt / 2,            //
      std::pow(dt, 3) / 6, dt * dt / 2, dt;
  StateMatrix Q = StateMatrix::Zero(9, 9);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      Q.block<3, 3>(3 * row, 3 * column).diagonal().setConstant(jerk_density_ * q(row, column));
    }
  }
  return Q;
}

Gaussian ConstantAcceleration::initial_belief(const Eigen::Vector3d& position,
                                              const Eigen::Matrix3d& covariance) const {
  Gaussian belief{State::Zero(9), StateMatrix::Identity(9, 9)};
  belief.mean.head<3>() = position;
  belief.covariance.topLeftCorner<3, 3>() = covariance;
  return belief;
}

Oscillation::Oscillation(const OscillationNoise& noise) : noise_(noise) {
  require_between("acceleration_density", noise.acceleration_density, kLeastDensity, kMostDensity,
                  "(m/s^2)^2/Hz");
  require_between("centre_density", noise.centre_density, kLeastDensity, kMostDensity,
                  "(m/s)^2/Hz");
  require_between("frequency_density", noise.frequency_density, kLeastDensity, kMostDensity, "1/s");
}

namespace {

double frequency_of(double logarithm) {
  constexpr double kFastest = 3.0;  // ln(20 rad/s): sigma points far off must stay finite
  return std::exp(std::clamp(logarithm, -kFastest, kFastest));
}

}  // namespace

Points Oscillation::advance(const Points& states, double dt) const {
  Points next = states;
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    const auto state = states.col(i);
    const double W = frequency_of(state(9));
    const double cosine = std::cos(W * dt);
    const double sine = std::sin(W * dt);
    const Eigen::Vector3d swing = state.head<3>() - state.segment<3>(6);
    next.col(i).head<3>() = state.segment<3>(6) + cosine * swing + sine / W * state.segment<3>(3);
    next.col(i).segment<3>(3) = -W * sine * swing + cosine * state.segment<3>(3);
  }
  return next;
}

StateMatrix Oscillation::jacobian(const State& state, double dt) const {
  const double W = frequency_of(state(9));
  const double turn = W * dt;
  const double cosine = std::cos(turn);
  const double sine = std::sin(turn);
  const Eigen::Vector3d swing = state.head<3>() - state.segment<3>(6);
  const Eigen::Vector3d velocity = state.segment<3>(3);
  StateMatrix F = StateMatrix::Identity(10, 10);
  for (int axis = 0; axis < 3; ++axis) {
    F.row(axis).setZero();
    F(axis, axis) = cosine;
    F(axis, 3 + axis) = sine / W;
    F(axis, 6 + axis) = 1 - cosine;
    F(axis, 9) = -sine * turn * swing(axis) + (cosine * turn - sine) / W * velocity(axis);
    F(3 + axis, axis) = -W * sine;
    F(3 + axis, 3 + axis) = cosine;
    F(3 + axis, 6 + axis) = W * sine;
    F(3 + axis, 9) = -W * (sine + cosine * turn) * swing(axis) - sine * turn * velocity(axis);
  }
  return F;
}

StateMatrix Oscillation::process_noise(double dt) const {
  const VelocityDecay pushed{noise_.acceleration_density, std::numeric_limits<double>::infinity()};
  StateMatrix Q = StateMatrix::Zero(10, 10);
  Q.topLeftCorner<6, 6>() = for_three_axes(pushed.noise(dt));
  Q.diagonal().segment<3>(6).setConstant(noise_.centre_density * dt);
  Q(9, 9) = noise_.frequency_density * dt;
  return Q;
}

Gaussian Oscillation::initial_belief(const Eigen::Vector3d& position,
                                     const Eigen::Matrix3d& covariance) const {
  constexpr double kSpeed = 0.2;               // m/s
  constexpr double kSwing = 0.05;              // m
  constexpr double kLikelyLogFrequency = 0.7;  // ln(2 rad/s)
  constexpr double kLogFrequencySigma = 0.4;
  Gaussian belief{State::Zero(10), StateMatrix::Zero(10, 10)};
  belief.mean.head<3>() = position;
  belief.mean.segment<3>(6) = position;
  belief.mean(kLogFrequency) = kLikelyLogFrequency;
  belief.covariance.topLeftCorner<3, 3>() = covariance;
  belief.covariance.diagonal().segment<3>(3).setConstant(kSpeed * kSpeed);
  belief.covariance.diagonal().segment<3>(6).setConstant(kSwing * kSwing);
  belief.covariance(9, 9) = kLogFrequencySigma * kLogFrequencySigma;
  return belief;
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
