// SPDX-License-Identifier: BSD-3-Clause
// A normally distributed vector, and what keeps its covariance a covariance.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace prf_predictor {

// Of at most kMostStates numbers, so that they need no heap.
constexpr int kMostStates = 10;
using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostStates, 1>;
using StateMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostStates, kMostStates>;

struct Gaussian {
  State mean;
  StateMatrix covariance;
};

[[nodiscard]] bool is_finite(const Gaussian& gaussian);

// True for a finite, symmetric (relative 1e-6), positive definite matrix.
[[nodiscard]] bool is_covariance(const StateMatrix& matrix);

// The nearest symmetric matrix, with eigenvalues below 1e-12 of the largest raised to that. A
// matrix that is already positive definite is only symmetrised.
[[nodiscard]] StateMatrix repaired(const StateMatrix& covariance);

// Some L with L L^T = P for a positive semidefinite P.
[[nodiscard]] StateMatrix square_root(const StateMatrix& covariance);

}  // namespace prf_predictor
