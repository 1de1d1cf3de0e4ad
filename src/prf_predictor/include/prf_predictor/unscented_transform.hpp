// SPDX-License-Identifier: BSD-3-Clause
// The scaled unscented transform (Julier; Wan and van der Merwe, 2000): a Gaussian of dimension n
// through a function, by 2 n + 1 points. With lambda = alpha^2 (n + kappa) - n:
//   x_0 = m,  x_i = m +- column i of sqrt((n + lambda) P)
//   w_0 (mean) = lambda / (n + lambda),  w_0 (covariance) = w_0 (mean) + 1 - alpha^2 + beta
//   w_i = 1 / (2 (n + lambda)).
#pragma once

#include <Eigen/Core>

#include "prf_predictor/gaussian.hpp"

namespace prf_predictor {

struct SigmaPointParams {
  double alpha = 0.0;  // spread of the points, 0 < alpha <= 1
  double beta = 0.0;   // 2 is optimal for Gaussians, >= 0
  double kappa = 0.0;  // n + kappa > 0 for all n, so >= 0

  static SigmaPointParams paper() { return {1.0, 2e-6, 0.0}; }  // as the paper prints them
  static SigmaPointParams textbook() { return {0.5, 2.0, 0.0}; }

  void validate() const;
};

constexpr int kMostPoints = 2 * kMostStates + 1;
using Points = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostStates, kMostPoints>;
using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostPoints, 1>;

// One column per point; the first is the mean.
struct SigmaPoints {
  Points points;
  Weights mean_weights;
  Weights covariance_weights;
};

[[nodiscard]] SigmaPoints sigma_points(const Gaussian& belief, const SigmaPointParams& params);

struct VectorMean {
  // The first point plus the mean distance to it: large weights of both signs cancel exactly.
  State operator()(const Points& points, const Weights& weights) const {
    State sum = State::Zero(points.rows());
    for (Eigen::Index i = 1; i < points.cols(); ++i) {
      sum += weights(i) * (points.col(i) - points.col(0));
    }
    return points.col(0) + sum;
  }
};

struct VectorResidual {
  Points operator()(const Points& points, const State& mean) const {
    return points.colwise() - mean;
  }
};

// `function` takes all points at once, one a column. `mean` and `residual` (of all points) say how
// to average and to subtract where results are no plain vectors.
template <typename Function, typename Mean = VectorMean, typename Residual = VectorResidual>
[[nodiscard]] Gaussian unscented_transform(const Gaussian& belief, const SigmaPointParams& params,
                                           const Function& function, const Mean& mean = {},
                                           const Residual& residual = {}) {
  const SigmaPoints sigma = sigma_points(belief, params);
  const Points images = function(sigma.points);
  Gaussian result;
  result.mean = mean(images, sigma.mean_weights);
  const Points deviations = residual(images, result.mean);
  result.covariance.setZero(images.rows(), images.rows());
  for (Eigen::Index i = 0; i < images.cols(); ++i) {
    for (Eigen::Index j = 0; j < images.rows(); ++j) {
      result.covariance.col(j) +=
          (sigma.covariance_weights(i) * deviations(j, i)) * deviations.col(i);
    }
  }
  return result;
}

}  // namespace prf_predictor
