// SPDX-License-Identifier: BSD-3-Clause
//
// The Hessian of J in the steps v_i = y_i - y_{i-1}, one dimension, halved: tridiagonal, diagonal
// w_E + q (number of neighbours), off-diagonal -q. Eliminated from the last step backward, so that
// the pivots serve every number of fixed rows, as q + delta with positive delta only.
//
// Where too little is fixed the Hessian is singular along y_0 (nothing fixed) and v_1 (no elastic
// term either); there it gets the weight of a proximal term.
#pragma once

#include <Eigen/Core>

#include "elte_planner/elte_energy.hpp"

namespace elte_planner {

class StepChain {
 public:
  static constexpr double kProximalWeight = 1e-3;

  void factorise(const Eigen::MatrixXd& zeta, const ElteWeights& weights, Eigen::Index fixed_rows);

  Eigen::Index first_step() const { return first_; }  // first free step
  bool start_is_free() const { return start_is_free_; }
  bool slope_is_free() const { return slope_is_free_; }
  bool is_proximal() const { return start_is_free_ || slope_is_free_; }

  // Solves Hessian x = b over the free steps, in place. Entries before first_step() are not used.
  void solve(double* b) const;

  // Nodes' displacement under a unit force that acts on node k: y[first_step()-1 .. nodes-1].
  void respond_to_node_force(Eigen::Index k, double* y) const;
  // The same under a unit force that stretches step k.
  void respond_to_step_force(Eigen::Index k, double* y) const;

 private:
  void integrate(const double* steps, double start, double* y) const;

  Eigen::Index n_ = 0;
  Eigen::Index first_ = 1;
  bool start_is_free_ = false;
  bool slope_is_free_ = false;
  double q_ = 0.0;
  Eigen::VectorXd inverse_pivot_;
  Eigen::VectorXd coupling_;  // q / pivot
};

}  // namespace elte_planner
