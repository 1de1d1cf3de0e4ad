// SPDX-License-Identifier: BSD-3-Clause
// A normally distributed vector, and what keeps its covariance a covariance.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace prf_predictor {

struct Gaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

[[nodiscard]] bool is_finite(const Gaussian& gaussian);

// True for a finite, symmetric (relative 1e-6), positive definite matrix.
[[nodiscard]] bool is_covariance(const Eigen::MatrixXd& matrix);

// The nearest symmetric matrix, with eigenvalues below 1e-12 of the largest raised to that. A
// matrix that is already positive definite is only symmetrised.
[[nodiscard]] Eigen::MatrixXd repaired(const Eigen::MatrixXd& covariance);

// Some L with L L^T = P for a positive semidefinite P.
[[nodiscard]] Eigen::MatrixXd square_root(const Eigen::MatrixXd& covariance);

// The value below which a chi-square variable of three degrees of freedom lies with the
// probability p in (0, 1).
[[nodiscard]] double chi_square_quantile_3(double p);

}  // namespace prf_predictor
