// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic/model_weights.hpp"

#include <cmath>

namespace prf_predictor {
namespace {

constexpr double kOwn = 1.5;  // independent errors

}  // namespace

ModelWeights::ModelWeights(const Eigen::ArrayXd& prior) : log_prior_(prior) {
  for (double& value : log_prior_) value = std::log(value);
}

void ModelWeights::update(const ForecastScorer& scorer) {
  Eigen::ArrayXd evidence = Eigen::ArrayXd::Zero(log_prior_.size());
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    const double errors = scorer.evidence(k) / ForecastScorer::kIndependent[k];
    evidence *= std::exp(-errors / kOwn);
    evidence -= 1.5 * errors * scorer.log_error(k);
    Eigen::ArrayXd weight = log_prior_ + evidence;
    weight = (weight - weight.maxCoeff()).exp();
    weight /= weight.sum();
    weights_[k] = weight;
  }
}

Eigen::ArrayXd ModelWeights::at(double age) const {
  const BetweenHorizons between = between_horizons(age);
  return (1 - between.fraction) * weights_[between.lower] +
         between.fraction * weights_[between.upper];
}

}  // namespace prf_predictor
