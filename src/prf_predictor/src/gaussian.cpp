// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/gaussian.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace prf_predictor {
namespace {

constexpr double kSymmetry = 1e-6;
constexpr double kSmallestEigenvalue = 1e-12;

bool is_positive_definite(const Eigen::MatrixXd& matrix) {
  return matrix.llt().info() == Eigen::Success;
}

}  // namespace

bool is_finite(const Gaussian& gaussian) {
  return gaussian.mean.allFinite() && gaussian.covariance.allFinite();
}

bool is_covariance(const Eigen::MatrixXd& matrix) {
  return matrix.allFinite() &&
         (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <=
             kSymmetry * matrix.cwiseAbs().maxCoeff() &&
         is_positive_definite(matrix);
}

Eigen::MatrixXd repaired(const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd symmetric = 0.5 * (covariance + covariance.transpose());
  if (is_positive_definite(symmetric)) return symmetric;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(symmetric);
  const double floor = kSmallestEigenvalue * eigen.eigenvalues().cwiseAbs().maxCoeff();
  const Eigen::VectorXd values = eigen.eigenvalues().cwiseMax(floor);
  const Eigen::MatrixXd result =
      eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  return 0.5 * (result + result.transpose());
}

Eigen::MatrixXd square_root(const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
  if (cholesky.info() == Eigen::Success) return cholesky.matrixL();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  const Eigen::VectorXd roots = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return eigen.eigenvectors() * roots.asDiagonal();
}

double chi_square_quantile_3(double p) {
  // F(x) = erf(sqrt(x / 2)) - sqrt(2 x / pi) exp(-x / 2)
  const auto cdf = [](double x) {
    return std::erf(std::sqrt(x / 2)) - std::sqrt(2 * x / M_PI) * std::exp(-x / 2);
  };
  double low = 0.0;
  double high = 100.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (cdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace prf_predictor
