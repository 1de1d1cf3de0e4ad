// SPDX-License-Identifier: BSD-3-Clause
#include "step_chain.hpp"

#include <algorithm>

namespace elte_planner {

void StepChain::factorise(Eigen::Index nodes, const ElteWeights& weights, Eigen::Index fixed_rows,
                          double proximal_weight) {
  const bool same = nodes == n_ && weights.elastic == weights_.elastic &&
                    weights.bending == weights_.bending && weights.laplacian == weights_.laplacian;
  if (!same) eliminate(nodes, weights);
  const bool end_rows = weights.laplacian == Laplacian::kRowNormalised;
  proximal_weight_ = proximal_weight;
  first_ = std::max<Eigen::Index>(fixed_rows, 1);
  start_is_free_ = fixed_rows == 0;
  slope_is_free_ = fixed_rows <= 1 && weights.elastic == 0.0 && !end_rows;
  const double pivot =
      first_delta_ + (end_rows ? 1.0 : 0.0) + (slope_is_free_ ? proximal_weight_ : 0.0);
  inverse_pivot_[1] = 1.0 / pivot;
}

void StepChain::eliminate(Eigen::Index nodes, const ElteWeights& weights) {
  n_ = nodes;
  weights_ = weights;
  const double q = weights.curvature();
  inverse_pivot_.resize(n_);
  coupling_.resize(n_);
  double delta = weights.elastic + (weights.laplacian == Laplacian::kRowNormalised ? 1.0 : 0.0);
  for (Eigen::Index i = n_ - 1; i >= 2; --i) {
    inverse_pivot_[i] = 1.0 / (q + delta);
    coupling_[i] = q * inverse_pivot_[i];
    delta = weights.elastic + delta * coupling_[i];
  }
  first_delta_ = delta;
}

void StepChain::solve(Eigen::MatrixXd& b) const {
  Eigen::Index j = 0;
  for (; j + 2 <= b.cols(); j += 2) solve_columns<2>(b.col(j).data());
  if (j < b.cols()) solve_columns<1>(b.col(j).data());
}

// Each column is a chain of dependent operations; two of them side by side keep the processor busy.
template <int kColumns>
void StepChain::solve_columns(double* b) const {
  double x[kColumns];
  for (int c = 0; c < kColumns; ++c) x[c] = b[c * n_ + n_ - 1];
  for (Eigen::Index i = n_ - 2; i >= first_; --i) {
    for (int c = 0; c < kColumns; ++c) {
      b[c * n_ + i] = x[c] = b[c * n_ + i] + coupling_[i + 1] * x[c];
    }
  }
  for (int c = 0; c < kColumns; ++c) b[c * n_ + first_] = x[c] *= inverse_pivot_[first_];
  for (Eigen::Index i = first_ + 1; i < n_; ++i) {
    for (int c = 0; c < kColumns; ++c) {
      b[c * n_ + i] = x[c] = inverse_pivot_[i] * b[c * n_ + i] + coupling_[i] * x[c];
    }
  }
}

void StepChain::respond_to_node_force(Eigen::Index k, double* y) const {
  double below = 0.0;
  for (Eigen::Index i = k; i >= first_; --i) {
    below = 1.0 + (i < k ? coupling_[i + 1] * below : 0.0);
    y[i] = below;
  }
  std::fill(y + k + 1, y + n_, 0.0);
  integrate(y, start_is_free_ ? 1.0 / proximal_weight_ : 0.0, y);
}

void StepChain::respond_to_step_force(Eigen::Index k, double* y) const {
  double below = 1.0;
  y[k] = 1.0;
  for (Eigen::Index i = k - 1; i >= first_; --i) {
    below *= coupling_[i + 1];
    y[i] = below;
  }
  std::fill(y + k + 1, y + n_, 0.0);
  integrate(y, 0.0, y);
}

void StepChain::integrate(const double* eliminated, double start, double* y) const {
  double step = inverse_pivot_[first_] * eliminated[first_];
  double sum = start + step;
  y[first_ - 1] = start;
  y[first_] = sum;
  for (Eigen::Index i = first_ + 1; i < n_; ++i) {
    step = inverse_pivot_[i] * eliminated[i] + coupling_[i] * step;
    sum += step;
    y[i] = sum;
  }
}

}  // namespace elte_planner
