// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic/spectral_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prf_predictor {
namespace {

constexpr double kDriftSpeed =
    0.3;  // m/s, standard deviation of the velocity of a drift after one measurement

}  // namespace

Transition transition(const VelocityDecay& drift, double dt) {
  Transition result;
  result.F << 1, drift.travel(dt), 0, drift.velocity_factor(dt);
  result.Q = drift.noise(dt);
  return result;
}

Transition transition(const DampedOscillator& oscillator, double dt) {
  const double W = oscillator.frequency;
  const double decay = oscillator.damping_ratio * W;
  const double damped = W * std::sqrt(1 - oscillator.damping_ratio * oscillator.damping_ratio);
  const double envelope = std::exp(-decay * dt);
  const double cosine = envelope * std::cos(damped * dt);
  const double sine = envelope * std::sin(damped * dt) / damped;
  Transition result;
  result.F << cosine + decay * sine, sine, -W * W * sine, cosine - decay * sine;
  const Eigen::Matrix2d S =
      std::pow(oscillator.sigma, 2) * Eigen::Vector2d(1, W * W).asDiagonal().toDenseMatrix();
  result.Q = S - result.F * S * result.F.transpose();
  return result;
}

std::vector<Transition> Components::transitions(double dt) const {
  std::vector<Transition> result{transition(drift, dt)};
  for (const DampedOscillator& oscillator : oscillators)
    result.push_back(transition(oscillator, dt));
  return result;
}

SpectralBelief::SpectralBelief(const Components& components,
                               std::shared_ptr<const std::vector<int>> used,
                               const Eigen::Vector3d& position, double variance)
    : used_(std::move(used)) {
  const auto size = 2 * static_cast<Eigen::Index>(used_->size());
  x_.setZero(size, 3);
  for (Eigen::Index i = 0; i < size; i += 2) {
    if ((*used_)[static_cast<std::size_t>(i / 2)] == 0) x_.row(i) = position;
  }
  unsettle(components, variance);
  correct(position, variance);
}

void SpectralBelief::unsettle(const Components& components, double variance) {
  P_.setZero(x_.rows(), x_.rows());
  double unknown = variance;
  for (Eigen::Index row = 0; row < x_.rows(); row += 2) {
    const int component = (*used_)[static_cast<std::size_t>(row / 2)];
    if (component == 0) {
      P_(row + 1, row + 1) = std::min(components.drift.prior_variance(), kDriftSpeed * kDriftSpeed);
      continue;
    }
    const DampedOscillator& oscillator =
        components.oscillators[static_cast<std::size_t>(component - 1)];
    P_(row, row) = std::pow(oscillator.sigma, 2);
    P_(row + 1, row + 1) = std::pow(oscillator.sigma * oscillator.frequency, 2);
    unknown += P_(row, row);
  }
  for (Eigen::Index row = 0; row < x_.rows(); row += 2) {
    if ((*used_)[static_cast<std::size_t>(row / 2)] == 0) P_(row, row) = unknown;
  }
}

void SpectralBelief::advance(const std::vector<Transition>& transitions) {
  const auto count = static_cast<Eigen::Index>(used_->size());
  const auto of = [&](Eigen::Index i) -> const Transition& {
    return transitions[static_cast<std::size_t>((*used_)[static_cast<std::size_t>(i)])];
  };
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Matrix2d& F = of(i).F;
    x_.middleRows<2>(2 * i) = (F * x_.middleRows<2>(2 * i)).eval();
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Eigen::Matrix2d block = P_.block<2, 2>(2 * i, 2 * j);
      P_.block<2, 2>(2 * i, 2 * j) = F * block * of(j).F.transpose();
    }
    P_.block<2, 2>(2 * i, 2 * i) += of(i).Q;
  }
  P_.triangularView<Eigen::StrictlyUpper>() = P_.transpose();
}

void SpectralBelief::correct(const Eigen::Vector3d& position, double variance) {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1> PH;
  PH.setZero(P_.rows());
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < P_.rows(); i += 2) {
    PH += P_.col(i);
    expected += x_.row(i).transpose();
  }
  double S = variance;
  for (Eigen::Index i = 0; i < P_.rows(); i += 2) S += PH(i);
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1> gain = PH / S;
  const Eigen::Vector3d innovation = position - expected;
  for (int axis = 0; axis < 3; ++axis) x_.col(axis) += innovation(axis) * gain;
  for (Eigen::Index i = 0; i < P_.cols(); ++i) P_.col(i) -= PH(i) * gain;
}

SpectralBelief::Forecast SpectralBelief::forecast(
    const std::vector<Transition>& transitions) const {
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMost> G;  // position and velocity of the state
  G.setZero(2, P_.rows());
  Eigen::Matrix2d Q = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < used_->size(); ++i) {
    const Transition& component = transitions[static_cast<std::size_t>((*used_)[i])];
    G.middleCols<2>(2 * static_cast<Eigen::Index>(i)) = component.F;
    Q += component.Q;
  }
  const Eigen::Matrix<double, 2, 3> mean = G * x_;
  return {mean.row(0), mean.row(1), G * P_ * G.transpose() + Q};
}

Eigen::Vector3d SpectralBelief::position(const std::vector<Transition>& transitions) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Index row = 0;
  for (const int component : *used_) {
    const Eigen::Matrix2d& F = transitions[static_cast<std::size_t>(component)].F;
    for (int axis = 0; axis < 3; ++axis) {
      sum(axis) += F(0, 0) * x_(row, axis) + F(0, 1) * x_(row + 1, axis);
    }
    row += 2;
  }
  return sum;
}

}  // namespace prf_predictor
