// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic/model_weights.hpp"

#include <cmath>

namespace prf_predictor {

ModelWeights::ModelWeights(const Eigen::ArrayXd& prior) : log_prior_(prior) {
  for (double& value : log_prior_) value = std::log(value);
}

void ModelWeights::update(const ForecastScorer& scorer) {
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    const ForecastScorer::Score score = scorer.score(k);
    Eigen::ArrayXd weight = log_prior_;
    if (score.evidence > 0) {
      weight -= 1.5 * score.evidence / ForecastScorer::kIndependent[k] * score.log_error;
    } else if (k > 0) {
      weight = weights_[k - 1].log();
    }
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
