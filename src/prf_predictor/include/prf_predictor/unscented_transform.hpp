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
};

// Throws std::invalid_argument naming the parameter, its value and its bound.
void validate(const SigmaPointParams& params);

// One column per point; the first is the mean.
struct SigmaPoints {
  Eigen::MatrixXd points;
  Eigen::VectorXd mean_weights;
  Eigen::VectorXd covariance_weights;
};

[[nodiscard]] SigmaPoints sigma_points(const Gaussian& belief, const SigmaPointParams& params);

struct Transformed {
  Gaussian result;
  Eigen::MatrixXd cross_covariance;  // of input and result
};

struct VectorMean {
  // The first point plus the mean distance to it: large weights of both signs cancel exactly.
  Eigen::VectorXd operator()(const Eigen::MatrixXd& points, const Eigen::VectorXd& weights) const {
    return points.col(0) + (points.colwise() - points.col(0)) * weights;
  }
};

struct VectorResidual {
  Eigen::VectorXd operator()(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return a - b;
  }
};

// `mean` and `residual` say how to average and to subtract where results are no plain vectors.
template <typename Function, typename Mean = VectorMean, typename Residual = VectorResidual>
[[nodiscard]] Transformed unscented_transform(const Gaussian& belief,
                                              const SigmaPointParams& params,
                                              const Function& function, const Mean& mean = {},
                                              const Residual& residual = {}) {
  const SigmaPoints sigma = sigma_points(belief, params);
  const Eigen::VectorXd first = function(sigma.points.col(0));
  Eigen::MatrixXd images(first.size(), sigma.points.cols());
  images.col(0) = first;
  for (Eigen::Index i = 1; i < sigma.points.cols(); ++i) {
    images.col(i) = function(sigma.points.col(i));
  }

  Transformed transformed;
  transformed.result.mean = mean(images, sigma.mean_weights);
  Eigen::MatrixXd deviations(images.rows(), images.cols());
  for (Eigen::Index i = 0; i < images.cols(); ++i) {
    deviations.col(i) = residual(images.col(i), transformed.result.mean);
  }
  const Eigen::MatrixXd weighted = deviations * sigma.covariance_weights.asDiagonal();
  transformed.result.covariance = weighted * deviations.transpose();
  transformed.cross_covariance = (sigma.points.colwise() - belief.mean) * weighted.transpose();
  return transformed;
}

}  // namespace prf_predictor
