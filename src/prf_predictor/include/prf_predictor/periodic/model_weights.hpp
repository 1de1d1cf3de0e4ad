// SPDX-License-Identifier: BSD-3-Clause
// Probabilities of candidate models, apart for each horizon: a model is believed at a horizon as
// far as its past predictions at that horizon were good.
//
// L_i is the mean of ln(e_ij^2 + r) over the errors of candidate i in the last seconds, with r the
// variance of the measurement (sum of the axes), below which errors tell nothing, and T the time
// that it covers (forecast_scorer.hpp). With predictions tau apart being independent, T is worth
// n = T / tau errors on three axes. When the variance of each error is unknown and integrated out,
// the probability is
//   w_i ~ prior_i exp(-3/2 n L_i)
// A mean of squares in place of the logarithms would remember one large error, as of a model before
// it has learnt the motion, long after it has become good. Errors at long horizons come late, so
// those at the next shorter one count until there are some: with M_ik = -3/2 n L_i at the horizon
// k,
//   ln w_ik = ln prior_i + S_ik + constant,   S_ik = M_ik + exp(-n_k / kOwn) S_i(k-1)
#pragma once

#include <Eigen/Core>
#include <array>

#include "prf_predictor/forecast_scorer.hpp"

namespace prf_predictor {

class ModelWeights {
 public:
  explicit ModelWeights(const Eigen::ArrayXd& prior);

  void update(const ForecastScorer& scorer);

  // Linear between the scorer's horizons. `age`: s since the latest measurement.
  [[nodiscard]] Eigen::ArrayXd at(double age) const;

 private:
  Eigen::ArrayXd log_prior_;
  std::array<Eigen::ArrayXd, ForecastScorer::kHorizons.size()> weights_;
};

}  // namespace prf_predictor
