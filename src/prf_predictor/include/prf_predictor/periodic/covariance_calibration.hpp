// SPDX-License-Identifier: BSD-3-Clause
// Makes predicted covariances agree with the errors that were observed: the standard deviation of
// each axis is scaled by the covariance inflation that past predictions showed.
//
// With p_k the variance predicted at the scorer's horizon h_k and G_k its inflation
// (forecast_scorer.hpp), a prediction of age a (time since the latest measurement plus horizon) has
//   sigma(h_k) = sqrt(p_k G_k),  linear in a between two h_k, proportional to a beyond the last.
// Below the first horizon the inflation is linear in a, from that of the innovations,
//   G_0 <- G_0 + (1 - exp(-dt / innovation_memory)) ((nu^2 - r) / p - G_0),
// nu being the innovation, r the measurement's variance and p the predicted one. G is not less than
// `least_inflation`, sigma not less than `least_noise_share` times the measurement's.
#pragma once

#include <Eigen/Core>
#include <array>

#include "prf_predictor/forecast_scorer.hpp"

namespace prf_predictor {

class CovarianceCalibration {
 public:
  CovarianceCalibration(double innovation_memory, double least_noise_share, double least_inflation);

  // `elapsed`: dt since the measurement before, s. Variances are of each axis, m^2.
  void observe(const Eigen::Vector3d& innovation, const Eigen::Vector3d& noise_variance,
               const Eigen::Vector3d& predicted_variance, double elapsed);
  void set_noise(const Eigen::Vector3d& noise_variance) { noise_variance_ = noise_variance; }
  // The variance predicted now at the scorer's horizon.
  void set_predicted(std::size_t horizon, const Eigen::Array3d& variance) {
    predicted_[horizon] = variance;
  }

  // Standard deviation of a prediction of this age, given its variance before calibration.
  [[nodiscard]] Eigen::Array3d sigma(double age, const Eigen::Array3d& variance,
                                     const ForecastScorer& scorer) const;

 private:
  [[nodiscard]] Eigen::Array3d inflated_sigma(double age, const Eigen::Array3d& variance,
                                              const ForecastScorer& scorer) const;

  double innovation_memory_;
  double least_noise_share_;
  double least_inflation_;
  Eigen::Array3d innovation_inflation_ = Eigen::Array3d::Ones();
  Eigen::Vector3d noise_variance_ = Eigen::Vector3d::Zero();
  std::array<Eigen::Array3d, ForecastScorer::kHorizons.size()> predicted_;
};

}  // namespace prf_predictor
