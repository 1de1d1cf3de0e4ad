// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/hmm/hmm_sequence.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

namespace prf_decision {
namespace {

constexpr double kImpossible = -std::numeric_limits<double>::infinity();

// Column k: ln b(o_k), with the excluded states at -infinity.
Eigen::Matrix3Xd log_densities(const HmmParams& parameters, const Sequence& sequence) {
  if (sequence.empty())
    throw std::invalid_argument("the sequence has 0 observations, must have at least 1");
  const EmissionModel emission(parameters);
  Eigen::Matrix3Xd result(3, static_cast<Eigen::Index>(sequence.size()));
  for (std::size_t k = 0; k < sequence.size(); ++k) {
    const auto& [velocity, label, spread, deviation] = sequence[k];
    Eigen::Vector3d column = Eigen::Vector3d::Zero();
    if (velocity) column = emission.log_density(ObservedMotion{*velocity, spread, deviation});
    for (Eigen::Index i = 0; label && i < 3; ++i) {
      if (i != static_cast<Eigen::Index>(*label)) column[i] = kImpossible;
    }
    result.col(static_cast<Eigen::Index>(k)) = column;
  }
  return result;
}

[[noreturn]] void refuse_impossible(Eigen::Index k) {
  throw std::invalid_argument("observation " + std::to_string(k) + " is impossible in the model");
}

Eigen::Vector3d exponential(const Eigen::Vector3d& values) {
  return values.unaryExpr([](double value) { return std::exp(value); });
}

Eigen::Index draw_from(const Eigen::Vector3d& probabilities, double uniform) {
  if (uniform < probabilities[0]) return 0;
  return uniform < probabilities[0] + probabilities[1] || probabilities[2] == 0 ? 1 : 2;
}

}  // namespace

SmoothingResult smooth(const HmmParams& parameters, const Sequence& sequence) {
  const Eigen::Matrix3Xd log_density = log_densities(parameters, sequence);
  const Eigen::Index n = log_density.cols();
  const Eigen::Matrix3d& a = parameters.transition;
  Eigen::Matrix3Xd density(3, n);  // relative to the largest of the observation
  Eigen::Matrix3Xd alpha(3, n);
  Eigen::VectorXd scale(n);
  SmoothingResult result;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double largest = log_density.col(k).maxCoeff();
    density.col(k) = exponential(log_density.col(k).array() - largest);
    const Eigen::Vector3d predicted =
        k == 0 ? parameters.initial : Eigen::Vector3d(a.transpose() * alpha.col(k - 1));
    alpha.col(k) = predicted.cwiseProduct(density.col(k));
    scale[k] = alpha.col(k).sum();
    if (!(scale[k] > 0)) refuse_impossible(k);
    alpha.col(k) /= scale[k];
    result.log_likelihood += std::log(scale[k]) + largest;
  }

  result.posterior = alpha;
  Eigen::Vector3d beta = Eigen::Vector3d::Ones();
  for (Eigen::Index k = n - 1; k > 0; --k) {
    const Eigen::Vector3d next = density.col(k).cwiseProduct(beta) / scale[k];
    result.transitions += a.cwiseProduct(alpha.col(k - 1) * next.transpose());
    beta = a * next;
    result.posterior.col(k - 1) = alpha.col(k - 1).cwiseProduct(beta);
  }
  return result;
}

ViterbiResult most_probable_path(const HmmParams& parameters, const Sequence& sequence) {
  const Eigen::Matrix3Xd log_density = log_densities(parameters, sequence);
  const Eigen::Index n = log_density.cols();
  const Eigen::Matrix3d log_transition = parameters.transition.array().log();
  Eigen::Matrix<Eigen::Index, 3, Eigen::Dynamic> before(3, n);
  Eigen::Vector3d best = parameters.initial.array().log().matrix() + log_density.col(0);
  for (Eigen::Index k = 1; k < n; ++k) {
    Eigen::Vector3d next;
    for (Eigen::Index to = 0; to < 3; ++to) {
      next[to] = (best + log_transition.col(to)).maxCoeff(&before(to, k)) + log_density(to, k);
    }
    best = next;
    if (best.maxCoeff() == kImpossible) refuse_impossible(k);
  }

  Eigen::Index state = 0;
  ViterbiResult path;
  path.log_probability = best.maxCoeff(&state);
  if (path.log_probability == kImpossible) refuse_impossible(0);
  path.states.resize(sequence.size());
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    path.states[static_cast<std::size_t>(k)] = static_cast<Intent>(state);
    if (k > 0) state = before(state, k);
  }
  return path;
}

Sequence draw(const HmmParams& parameters, std::size_t observations, std::uint32_t seed) {
  parameters.validate();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  Sequence sequence;
  Eigen::Vector3d distribution = parameters.initial;
  for (std::size_t k = 0; k < observations; ++k) {
    const Eigen::Index state = draw_from(distribution, uniform(random));
    const auto i = static_cast<std::size_t>(state);
    const Eigen::Matrix3d lower = parameters.covariance[i].llt().matrixL();
    Eigen::Vector3d noise;
    for (double& value : noise) value = normal(random);
    sequence.push_back({parameters.mean[i] + lower * noise, static_cast<Intent>(state)});
    distribution = parameters.transition.row(state).transpose();
  }
  return sequence;
}

}  // namespace prf_decision
