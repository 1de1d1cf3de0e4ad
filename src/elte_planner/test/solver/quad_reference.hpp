// SPDX-License-Identifier: BSD-3-Clause
//
// An independent solution in 113-bit arithmetic: the normal equations of J as a banded matrix,
// built from the definitions of L, E and R, factorised without pivoting.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "elte_planner/elte_energy.hpp"

namespace elte_planner {

class QuadReference {
 public:
  using Real = __float128;

  QuadReference(const Eigen::MatrixXd& zeta, const ElteWeights& weights)
      : n_(zeta.rows()), d_(zeta.cols()), band_(static_cast<std::size_t>(3 * n_)) {
    right_.assign(static_cast<std::size_t>(n_ * d_), Real(0));
    for (Eigen::Index k = 0; k + 2 < n_; ++k) {
      add_row(k, {1, -2, 1}, 0.25, &zeta);
      add_row(k, {1, -2, 1}, weights.bending, nullptr);
    }
    for (Eigen::Index k = 0; k + 1 < n_; ++k) {
      add_row(k, {-1, 1}, weights.elastic, nullptr);
      const bool end = k == 0 || k == n_ - 2;
      if (end && weights.laplacian == Laplacian::kRowNormalised) add_row(k, {-1, 1}, 1.0, &zeta);
    }
  }

  // The minimiser over rows frozen..free_end-1; the others are as in y.
  Eigen::MatrixXd solve(Eigen::Index frozen, Eigen::Index free_end,
                        const Eigen::MatrixXd& y) const {
    Eigen::MatrixXd result = y;
    for (Eigen::Index j = 0; j < d_; ++j) {
      const std::vector<Real> x = solve_dimension(frozen, free_end, y, j);
      for (Eigen::Index k = frozen; k < free_end; ++k) {
        result(k, j) = static_cast<double>(x[static_cast<std::size_t>(k)]);
      }
    }
    return result;
  }

 private:
  // Adds weight * |sum of coefficients times y - the same of target|^2 to J.
  void add_row(Eigen::Index first, const std::vector<int>& coefficients, double weight,
               const Eigen::MatrixXd* target) {
    const auto size = static_cast<Eigen::Index>(coefficients.size());
    for (Eigen::Index a = 0; a < size; ++a) {
      const Real scaled = Real(weight) * coefficients[static_cast<std::size_t>(a)];
      for (Eigen::Index b = a; b < size; ++b) {
        entry(first + a, b - a) += scaled * coefficients[static_cast<std::size_t>(b)];
      }
      if (target == nullptr) continue;
      for (Eigen::Index j = 0; j < d_; ++j) {
        Real value = 0;
        for (Eigen::Index b = 0; b < size; ++b) {
          value += Real((*target)(first + b, j)) * coefficients[static_cast<std::size_t>(b)];
        }
        right_[static_cast<std::size_t>((first + a) * d_ + j)] += scaled * value;
      }
    }
  }

  Real& entry(Eigen::Index row, Eigen::Index above) {
    return band_[static_cast<std::size_t>(3 * row + above)];
  }
  Real at(Eigen::Index row, Eigen::Index column) const {
    const Eigen::Index above = std::abs(column - row);
    if (above > 2) return 0;
    return band_[static_cast<std::size_t>(3 * std::min(row, column) + above)];
  }

  std::vector<Real> solve_dimension(Eigen::Index frozen, Eigen::Index free_end,
                                    const Eigen::MatrixXd& y, Eigen::Index j) const {
    const auto index = [](Eigen::Index k) { return static_cast<std::size_t>(k); };
    std::vector<Real> pivot(index(n_)), one(index(n_)), two(index(n_)), x(index(n_));
    for (Eigen::Index k = frozen; k < free_end; ++k) {
      Real value = right_[index(k * d_ + j)];
      for (Eigen::Index i = std::max<Eigen::Index>(k - 2, 0); i <= std::min(k + 2, n_ - 1); ++i) {
        if (i < frozen || i >= free_end) value -= at(k, i) * Real(y(i, j));
      }
      // L D L' with the factor's two subdiagonals.
      two[index(k)] = k - 2 >= frozen ? at(k, k - 2) / pivot[index(k - 2)] : Real(0);
      one[index(k)] = 0;
      pivot[index(k)] = at(k, k);
      if (k - 1 >= frozen) {
        Real coupling = at(k, k - 1);
        if (k - 2 >= frozen) coupling -= two[index(k)] * pivot[index(k - 2)] * one[index(k - 1)];
        one[index(k)] = coupling / pivot[index(k - 1)];
        pivot[index(k)] -= one[index(k)] * one[index(k)] * pivot[index(k - 1)];
        value -= one[index(k)] * x[index(k - 1)];
      }
      if (k - 2 >= frozen) {
        pivot[index(k)] -= two[index(k)] * two[index(k)] * pivot[index(k - 2)];
        value -= two[index(k)] * x[index(k - 2)];
      }
      x[index(k)] = value;
    }
    for (Eigen::Index k = free_end - 1; k >= frozen; --k) {
      x[index(k)] /= pivot[index(k)];
      if (k + 1 < free_end) x[index(k)] -= one[index(k + 1)] * x[index(k + 1)];
      if (k + 2 < free_end) x[index(k)] -= two[index(k + 2)] * x[index(k + 2)];
    }
    return x;
  }

  Eigen::Index n_;
  Eigen::Index d_;
  std::vector<Real> band_;   // upper band, three entries a row
  std::vector<Real> right_;  // L'L zeta
};

}  // namespace elte_planner
