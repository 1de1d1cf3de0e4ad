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
  // Costs next to nothing for the same number of nodes and the same weights as before.
  void factorise(Eigen::Index nodes, const ElteWeights& weights, Eigen::Index fixed_rows,
                 double proximal_weight);

  Eigen::Index first_step() const { return first_; }  // first free step
  bool start_is_free() const { return start_is_free_; }
  bool slope_is_free() const { return slope_is_free_; }
  bool is_proximal() const { return start_is_free_ || slope_is_free_; }
  double proximal_weight() const { return proximal_weight_; }

  // Solves Hessian x = b over the free steps, in place, each column of b on its own. Rows before
  // first_step() are not used.
  void solve(Eigen::MatrixXd& b) const;

  // Nodes' displacement under a unit force that acts on node k: y[first_step()-1 .. nodes-1].
  void respond_to_node_force(Eigen::Index k, double* y) const;
  // The same under a unit force that stretches step k.
  void respond_to_step_force(Eigen::Index k, double* y) const;

 private:
  void eliminate(Eigen::Index nodes, const ElteWeights& weights);
  template <int kColumns>
  void solve_columns(double* b) const;
  void integrate(const double* steps, double start, double* y) const;

  Eigen::Index n_ = 0;
  Eigen::Index first_ = 1;
  bool start_is_free_ = false;
  bool slope_is_free_ = false;
  ElteWeights weights_;
  double proximal_weight_ = 1.0;
  double first_delta_ = 0.0;  // delta of step 1, which has no step before it
  Eigen::VectorXd inverse_pivot_;
  Eigen::VectorXd coupling_;  // q / pivot
};

}  // namespace elte_planner
