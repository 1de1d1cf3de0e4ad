// SPDX-License-Identifier: BSD-3-Clause
// Probabilities of candidate models, apart for each horizon: a model is believed at a horizon as
// far as its past predictions at that horizon were good.
//
// E_i is the mean squared error of candidate i over the last seconds and T the time that it covers
// (forecast_scorer.hpp). With predictions tau apart being independent, T is worth n = T / tau
// errors on three axes. When the variance of the errors is unknown and integrated out, the
// probability is
//   w_i ~ prior_i (E_i + r)^(-3 n / 2)
// with r the variance of the measurement (sum of the axes), below which errors tell nothing. A
// horizon without evidence takes the weights of the next shorter one as they are.
#pragma once

#include <Eigen/Core>
#include <array>

#include "prf_predictor/forecast_scorer.hpp"

namespace prf_predictor {

class ModelWeights {
 public:
  explicit ModelWeights(const Eigen::ArrayXd& prior);

  void update(const ForecastScorer& scorer, double noise_variance);

  // Linear between the scorer's horizons. `age`: s since the latest measurement.
  [[nodiscard]] Eigen::ArrayXd at(double age) const;

 private:
  Eigen::ArrayXd log_prior_;
  std::array<Eigen::ArrayXd, ForecastScorer::kHorizons.size()> weights_;
};

}  // namespace prf_predictor
