// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/hmm.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace prf_decision {
namespace {

constexpr double kSumTolerance = 1e-9;        // of probabilities written with ten digits
constexpr double kSymmetryTolerance = 1e-12;  // m^2/s^2, rounding of a product at 1 m^2/s^2
constexpr double kMinVariance = 1e-8;         // (0.1 mm/s)^2, far below any sensor's noise

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

void validate_distribution(const Eigen::Vector3d& values, const std::string& name) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!(values[i] >= 0 && values[i] <= 1)) {
      refuse(name, "[", i, "] is ", values[i], ", must be in 0 .. 1");
    }
  }
  if (!(std::abs(values.sum() - 1) <= kSumTolerance)) {
    refuse(name, " sums to ", values.sum(), ", must be 1");
  }
}

void validate_covariance(const Eigen::Matrix3d& covariance, const std::string& name) {
  if (!covariance.allFinite()) refuse(name, " is not finite");
  const double asymmetry = (covariance - covariance.transpose()).cwiseAbs().maxCoeff();
  if (asymmetry > kSymmetryTolerance) refuse(name, " differs from its transpose by ", asymmetry);
  const double smallest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
          .eigenvalues()[0];
  if (!(smallest >= kMinVariance)) {
    refuse(name, " has smallest eigenvalue ", smallest, ", must be at least ", kMinVariance);
  }
}

void validate_reachable(const Eigen::Matrix3d& transition) {
  const Eigen::Matrix3d step = (transition.array() > 0).cast<double>();
  const Eigen::Matrix3d within_two = step + step * step;
  for (Eigen::Index from = 0; from < 3; ++from) {
    for (Eigen::Index to = 0; to < 3; ++to) {
      if (from != to && within_two(from, to) == 0) {
        refuse("transition: ", kIntentNames[static_cast<std::size_t>(to)],
               " can never be reached from ", kIntentNames[static_cast<std::size_t>(from)]);
      }
    }
  }
}

}  // namespace

void HmmParams::validate() const {
  validate_distribution(initial, "initial");
  for (std::size_t i = 0; i < kIntents; ++i) {
    validate_distribution(transition.row(static_cast<Eigen::Index>(i)).transpose(),
                          std::string("transition.") + kIntentNames[i]);
  }
  validate_reachable(transition);
  double slower = 0;
  for (std::size_t i = 0; i < kIntents; ++i) {
    if (!mean[i].allFinite()) refuse("mean.", kIntentNames[i], " is not finite");
    validate_covariance(covariance[i], std::string("covariance.") + kIntentNames[i]);
    const double speed = std::sqrt(mean_square_speed(*this, i));
    if (!(speed > slower)) {
      refuse("covariance.", kIntentNames[i], " gives an rms speed of ", speed,
             " m/s, must be above ", slower, " m/s of ", kIntentNames[i == 0 ? 0 : i - 1]);
    }
    slower = speed;
  }
}

double mean_square_speed(const HmmParams& parameters, std::size_t state) {
  return parameters.mean[state].squaredNorm() + parameters.covariance[state].trace();
}

EmissionModel::EmissionModel(const HmmParams& parameters) : mean_(parameters.mean) {
  for (std::size_t i = 0; i < kIntents; ++i) {
    validate_covariance(parameters.covariance[i], std::string("covariance.") + kIntentNames[i]);
    const Eigen::Matrix3d lower = parameters.covariance[i].llt().matrixL();
    whitening_[i] = lower.inverse();
    log_norm_[static_cast<Eigen::Index>(i)] =
        -1.5 * std::log(2 * M_PI) - lower.diagonal().array().log().sum();
  }
}

Eigen::Vector3d EmissionModel::log_density(const Eigen::Vector3d& velocity) const {
  if (!velocity.allFinite()) refuse("velocity is not finite");
  Eigen::Vector3d result = log_norm_;
  for (std::size_t i = 0; i < kIntents; ++i) {
    result[static_cast<Eigen::Index>(i)] -=
        0.5 * (whitening_[i] * (velocity - mean_[i])).squaredNorm();
  }
  return result;
}

HmmFilter::HmmFilter(const HmmParams& parameters)
    : parameters_((parameters.validate(), parameters)), emission_(parameters) {}

HmmBelief HmmFilter::initial_belief() const { return {parameters_.initial, false, 0}; }

HmmBelief HmmFilter::predict(const HmmBelief& belief) const {
  if (!belief.started) return {belief.posterior, true, belief.log_likelihood};
  const Eigen::Vector3d drifted = parameters_.transition.transpose() * belief.posterior;
  return {drifted / drifted.sum(), true, belief.log_likelihood};
}

HmmBelief HmmFilter::observe(const HmmBelief& belief, const Eigen::Vector3d& velocity) const {
  const HmmBelief predicted = predict(belief);
  // Scaled by the largest joint probability, so that a far outlier cannot underflow all states.
  const Eigen::Vector3d log_joint =
      predicted.posterior.array().log().matrix() + emission_.log_density(velocity);
  const double scale = log_joint.maxCoeff();
  const Eigen::Vector3d joint =
      log_joint.unaryExpr([scale](double value) { return std::exp(value - scale); });
  return {joint / joint.sum(), true, predicted.log_likelihood + scale + std::log(joint.sum())};
}

Intent most_probable(const HmmBelief& belief) {
  Eigen::Index best = 0;
  for (Eigen::Index i = 1; i < 3; ++i) {
    if (belief.posterior[i] >= belief.posterior[best]) best = i;
  }
  return static_cast<Intent>(best);
}

}  // namespace prf_decision
