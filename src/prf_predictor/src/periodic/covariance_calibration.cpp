// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/periodic/covariance_calibration.hpp"

#include <cmath>

namespace prf_predictor {

CovarianceCalibration::CovarianceCalibration(double innovation_memory, double least_noise_share,
                                             double least_inflation)
    : innovation_memory_(innovation_memory),
      least_noise_share_(least_noise_share),
      least_inflation_(least_inflation) {
  predicted_.fill(Eigen::Array3d::Zero());
}

void CovarianceCalibration::observe(const Eigen::Vector3d& innovation,
                                    const Eigen::Vector3d& noise_variance,
                                    const Eigen::Vector3d& predicted_variance, double elapsed) {
  const Eigen::Array3d ratio =
      (innovation.array().square() - noise_variance.array()) / predicted_variance.array();
  const double share = 1 - std::exp(-elapsed / innovation_memory_);
  innovation_inflation_ += share * (ratio - innovation_inflation_);
}

Eigen::Array3d CovarianceCalibration::inflated_sigma(double age, const Eigen::Array3d& variance,
                                                     const ForecastScorer& scorer) const {
  const auto& all = ForecastScorer::kHorizons;
  const Eigen::Array3d now = innovation_inflation_.max(least_inflation_);
  if (age < all.front()) {
    const Eigen::Array3d first = scorer.inflation(0).max(least_inflation_);
    return (variance * (now + age / all.front() * (first - now))).sqrt();
  }
  const BetweenHorizons between = between_horizons(age);
  const auto sigma_at = [&](std::size_t k) -> Eigen::Array3d {
    const double beyond = age > all.back() ? age / all.back() : 1.0;
    return beyond * (predicted_[k] * scorer.inflation(k).max(least_inflation_)).sqrt();
  };
  return sigma_at(between.lower) +
         between.fraction * (sigma_at(between.upper) - sigma_at(between.lower));
}

Eigen::Array3d CovarianceCalibration::sigma(double age, const Eigen::Array3d& variance,
                                            const ForecastScorer& scorer) const {
  return inflated_sigma(age, variance, scorer)
      .max(least_noise_share_ * noise_variance_.array().sqrt());
}

}  // namespace prf_predictor
