// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/unscented_transform.hpp"

#include <cmath>

#include <prf_core/require.hpp>

namespace prf_predictor {

using prf_core::require;

void SigmaPointParams::validate() const {
  require(alpha > 0 && alpha <= 1, "alpha", alpha, "> 0 and <= 1");
  require(beta >= 0 && std::isfinite(beta), "beta", beta, "finite and >= 0");
  require(kappa >= 0 && std::isfinite(kappa), "kappa", kappa, "finite and >= 0");
}

SigmaPoints sigma_points(const Gaussian& belief, const SigmaPointParams& params) {
  const Eigen::Index n = belief.mean.size();
  const double scale = params.alpha * params.alpha * (static_cast<double>(n) + params.kappa);
  const double lambda = scale - static_cast<double>(n);
  const StateMatrix spread = std::sqrt(scale) * square_root(belief.covariance);

  SigmaPoints sigma;
  sigma.points = belief.mean.replicate(1, 2 * n + 1);
  sigma.points.middleCols(1, n) += spread;
  sigma.points.rightCols(n) -= spread;
  sigma.mean_weights = Weights::Constant(2 * n + 1, 0.5 / scale);
  sigma.mean_weights(0) = lambda / scale;
  sigma.covariance_weights = sigma.mean_weights;
  sigma.covariance_weights(0) += 1.0 - params.alpha * params.alpha + params.beta;
  return sigma;
}

}  // namespace prf_predictor
