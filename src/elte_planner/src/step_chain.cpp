// SPDX-License-Identifier: BSD-3-Clause
#include "step_chain.hpp"

#include <algorithm>

namespace elte_planner {

void StepChain::factorise(const Eigen::MatrixXd& zeta, const ElteWeights& weights,
                          Eigen::Index fixed_rows) {
  n_ = zeta.rows();
  first_ = std::max<Eigen::Index>(fixed_rows, 1);
  q_ = weights.curvature();
  const bool end_rows = weights.laplacian == Laplacian::kRowNormalised;
  start_is_free_ = fixed_rows == 0;
  slope_is_free_ = fixed_rows <= 1 && weights.elastic == 0.0 && !end_rows;
  inverse_pivot_.resize(n_);
  coupling_.resize(n_);
  double delta = weights.elastic + (end_rows ? 1.0 : 0.0);
  for (Eigen::Index i = n_ - 1; i >= first_; --i) {
    if (i < n_ - 1) delta = weights.elastic + q_ * delta / (q_ + delta);
    double pivot = q_ + delta;
    if (i == 1 && fixed_rows <= 1) {
      // The first step of all has no step before it.
      pivot = delta + (end_rows ? 1.0 : 0.0) + (slope_is_free_ ? kProximalWeight : 0.0);
    }
    inverse_pivot_[i] = 1.0 / pivot;
    coupling_[i] = q_ / pivot;
  }
}

void StepChain::solve(double* b) const {
  for (Eigen::Index i = n_ - 2; i >= first_; --i) b[i] += coupling_[i + 1] * b[i + 1];
  b[first_] *= inverse_pivot_[first_];
  for (Eigen::Index i = first_ + 1; i < n_; ++i) {
    b[i] = inverse_pivot_[i] * b[i] + coupling_[i] * b[i - 1];
  }
}

void StepChain::respond_to_node_force(Eigen::Index k, double* y) const {
  double below = 0.0;
  for (Eigen::Index i = k; i >= first_; --i) {
    below = 1.0 + (i < k ? coupling_[i + 1] * below : 0.0);
    y[i] = below;
  }
  std::fill(y + k + 1, y + n_, 0.0);
  integrate(y, start_is_free_ ? 1.0 / kProximalWeight : 0.0, y);
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
