// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/hmm.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace prf_decision {
namespace {

constexpr double kSumTolerance = 1e-9;        // of probabilities written with ten digits
constexpr double kSymmetryTolerance = 1e-12;  // m^2/s^2, rounding of a product at 1 m^2/s^2
constexpr double kMinVariance = 1e-8;         // (0.1 mm/s)^2, far below any sensor's noise
constexpr double kMaxVariance = kMaxObservedSpeed * kMaxObservedSpeed;

constexpr double kMaxLogDeviation = 20;  // far beyond ln of any length here
constexpr double kMinLogSigma = 1e-3;    // a thousandth of the deviation

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
  const Eigen::Vector3d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
          .eigenvalues();
  if (!(eigenvalues[0] >= kMinVariance)) {
    refuse(name, " has smallest eigenvalue ", eigenvalues[0], ", must be at least ", kMinVariance);
  }
  if (!(eigenvalues[2] <= kMaxVariance)) {
    refuse(name, " has largest eigenvalue ", eigenvalues[2], ", must be at most ", kMaxVariance);
  }
}

void validate_deviations(const std::array<LogDeviation, kIntents>& deviations) {
  for (std::size_t i = 0; i < kIntents; ++i) {
    const std::string name = std::string("deviation.") + kIntentNames[i];
    const auto& [mean, sigma] = deviations[i];
    if (!(std::abs(mean) <= kMaxLogDeviation)) {
      refuse(name, "[0] is ", mean, ", must be within +-", kMaxLogDeviation);
    }
    if (!(sigma >= kMinLogSigma && sigma <= kMaxLogDeviation)) {
      refuse(name, "[1] is ", sigma, ", must be in ", kMinLogSigma, " .. ", kMaxLogDeviation);
    }
    if (i > 0 && !(mean > deviations[i - 1].mean)) {
      refuse(name, "[0] is ", mean, ", must be above that of ", kIntentNames[i - 1]);
    }
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
    if (!(mean[i].stableNorm() <= kMaxObservedSpeed)) {
      refuse("mean.", kIntentNames[i], " has ", mean[i].stableNorm(), " m/s, must be at most ",
             kMaxObservedSpeed);
    }
    validate_covariance(covariance[i], std::string("covariance.") + kIntentNames[i]);
    const double speed = std::sqrt(mean_square_speed(*this, i));
    if (!(speed > slower)) {
      refuse("covariance.", kIntentNames[i], " gives an rms speed of ", speed,
             " m/s, must be above ", slower, " m/s of ", kIntentNames[i == 0 ? 0 : i - 1]);
    }
    slower = speed;
  }
  if (deviation) validate_deviations(*deviation);
  if (!(weight >= 0.01 && weight <= 1)) refuse("weight is ", weight, ", must be in 0.01 .. 1");
}

double log_deviation(double deviation) {
  if (!(deviation >= 0)) refuse("deviation = ", deviation, ", must be >= 0 m");
  return std::log(std::min(deviation, kMaxDeviation) + kLeastDeviation);
}

double mean_square_speed(const HmmParams& parameters, std::size_t state) {
  return parameters.mean[state].squaredNorm() + parameters.covariance[state].trace();
}

EmissionModel::EmissionModel(const HmmParams& parameters)
    : mean_(parameters.mean), deviation_(parameters.deviation) {
  for (std::size_t i = 0; i < kIntents; ++i) {
    validate_covariance(parameters.covariance[i], std::string("covariance.") + kIntentNames[i]);
    const Eigen::Matrix3d lower = parameters.covariance[i].llt().matrixL();
    whitening_[i] = lower.inverse();
    log_norm_[static_cast<Eigen::Index>(i)] =
        -1.5 * std::log(2 * M_PI) - lower.diagonal().array().log().sum();
    precision_trace_[static_cast<Eigen::Index>(i)] = whitening_[i].squaredNorm();
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

Eigen::Vector3d EmissionModel::log_density(const ObservedMotion& observation) const {
  if (!(observation.spread >= 0 && std::isfinite(observation.spread))) {
    refuse("spread = ", observation.spread, ", must be finite and >= 0 m/s");
  }
  // stableNorm: the square of 1e300 is infinite.
  const double speed = observation.velocity.stableNorm();
  const double cut = speed > kMaxObservedSpeed ? kMaxObservedSpeed / speed : 1.0;
  const double spread = std::min(observation.spread, kMaxObservedSpeed);
  Eigen::Vector3d result = log_density(Eigen::Vector3d(cut * observation.velocity)) -
                           spread * spread / 6 * precision_trace_;
  if (!deviation_ || !observation.deviation) return result;
  const double x = log_deviation(*observation.deviation);
  for (std::size_t i = 0; i < kIntents; ++i) {
    const auto& [mean, sigma] = (*deviation_)[i];
    const double off = (x - mean) / sigma;
    result[static_cast<Eigen::Index>(i)] -=
        0.5 * (off * off + std::log(2 * M_PI)) + std::log(sigma);
  }
  return result;
}

bool is_distribution(const Eigen::Vector3d& values) {
  return (values.array() >= 0).all() && (values.array() <= 1).all() &&
         std::abs(values.sum() - 1) <= kSumTolerance;
}

HmmFilter::HmmFilter(const HmmParams& parameters)
    : parameters_((parameters.validate(), parameters)), emission_(parameters) {}

HmmBelief HmmFilter::initial_belief() const { return {parameters_.initial, false, 0, false}; }

HmmBelief HmmFilter::checked(const HmmBelief& belief) const {
  if (is_distribution(belief.posterior) && std::isfinite(belief.log_likelihood)) return belief;
  return {parameters_.initial, true, 0, true};
}

HmmBelief HmmFilter::predict(const HmmBelief& belief) const {
  HmmBelief predicted = checked(belief);
  if (!belief.started || predicted.was_reset) {
    predicted.started = true;
    return predicted;
  }
  const Eigen::Vector3d drifted = parameters_.transition.transpose() * predicted.posterior;
  predicted.posterior = drifted / drifted.sum();
  return checked(predicted);
}

HmmBelief HmmFilter::observe(const HmmBelief& belief, const ObservedMotion& observation) const {
  const Eigen::Vector3d log_density = parameters_.weight * emission_.log_density(observation);
  HmmBelief predicted = predict(belief);
  if (predicted.was_reset && !belief.was_reset) return predicted;
  // Scaled by the largest joint probability, so that a far outlier cannot underflow all states.
  const Eigen::Vector3d log_joint = predicted.posterior.array().log().matrix() + log_density;
  const double scale = log_joint.maxCoeff();
  const Eigen::Vector3d joint =
      log_joint.unaryExpr([scale](double value) { return std::exp(value - scale); });
  return checked(
      {joint / joint.sum(), true, predicted.log_likelihood + scale + std::log(joint.sum()), false});
}

Intent most_probable(const HmmBelief& belief) {
  if (belief.was_reset || !is_distribution(belief.posterior)) return Intent::kReverse;
  Eigen::Index best = 0;
  for (Eigen::Index i = 1; i < 3; ++i) {
    if (belief.posterior[i] >= belief.posterior[best]) best = i;
  }
  return static_cast<Intent>(best);
}

}  // namespace prf_decision
