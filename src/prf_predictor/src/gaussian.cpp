// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/gaussian.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace prf_predictor {
namespace {

constexpr double kSymmetry = 1e-6;
constexpr double kSmallestEigenvalue = 1e-12;

// The lower L with L L^T = P, row by row; none when P is not positive definite. For so few rows
// this is some times as fast as Eigen's, which is made for many.
std::optional<StateMatrix> cholesky(const StateMatrix& P) {
  const Eigen::Index n = P.rows();
  StateMatrix L = StateMatrix::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      double rest = P(i, j);
      for (Eigen::Index k = 0; k < j; ++k) rest -= L(i, k) * L(j, k);
      if (i > j) {
        L(i, j) = rest / L(j, j);
      } else if (rest > 0 && std::isfinite(rest)) {
        L(i, i) = std::sqrt(rest);
      } else {
        return std::nullopt;
      }
    }
  }
  return L;
}

}  // namespace

bool is_finite(const Gaussian& gaussian) {
  return gaussian.mean.allFinite() && gaussian.covariance.allFinite();
}

bool is_covariance(const StateMatrix& matrix) {
  return matrix.allFinite() &&
         (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <=
             kSymmetry * matrix.cwiseAbs().maxCoeff() &&
         cholesky(matrix).has_value();
}

StateMatrix repaired(const StateMatrix& covariance) {
  StateMatrix symmetric = 0.5 * (covariance + covariance.transpose());
  if (cholesky(symmetric)) return symmetric;
  const Eigen::SelfAdjointEigenSolver<StateMatrix> eigen(symmetric);
  const double floor = kSmallestEigenvalue * eigen.eigenvalues().cwiseAbs().maxCoeff();
  const State values = eigen.eigenvalues().cwiseMax(floor);
  const StateMatrix result =
      eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  return 0.5 * (result + result.transpose());
}

StateMatrix square_root(const StateMatrix& covariance) {
  if (const auto L = cholesky(covariance)) return *L;
  const Eigen::SelfAdjointEigenSolver<StateMatrix> eigen(covariance);
  const State roots = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return eigen.eigenvectors() * roots.asDiagonal();
}

}  // namespace prf_predictor
