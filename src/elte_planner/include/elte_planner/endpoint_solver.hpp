// SPDX-License-Identifier: BSD-3-Clause
//
// ELTE with one constraint on the last node, in closed form:
//
//   minimise J(y) of elte_energy.hpp over the rows frozen..N-1 of y
//   subject to |goal - y_{N-1}|_1 <= radius
//
// In the steps v_k = y_k - y_{k-1} and the error e_k = z - y_k to the end point z this is a
// linear-quadratic regulator: the optimal next step is Kv v + Ke e + kff, with gains that do not
// depend on how much is frozen, on the goal or on the radius. They are built once. The cost to go
// is isotropic over the dimensions, so the best end point in the l1 ball is the Euclidean
// projection of the best free one.
//
// The nodes are cut into blocks of consecutive nodes. Because e_k within a block is affine in (v,
// e) at the block's start, the tables of that map turn the roll-out, a chain of dependent
// operations, into independent ones per block.
#pragma once

#include <Eigen/Core>

#include "elte_planner/elte_energy.hpp"

namespace elte_planner {

class EndpointSolver {
 public:
  static constexpr Eigen::Index kMinFrozen = 2;

  // zeta: nodes x dimensions. Throws std::invalid_argument.
  EndpointSolver(const Eigen::MatrixXd& zeta, const ElteWeights& weights);

  Eigen::Index nodes() const { return best_error_feed_.rows(); }
  Eigen::Index dimensions() const { return best_error_feed_.cols(); }

  // Reads rows [0, frozen) of `plan` (nodes x dimensions) and writes the others. Needs
  // 2 <= frozen < nodes, radius >= 0 and finite values; throws std::invalid_argument otherwise.
  // Does not allocate.
  void solve(Eigen::Index frozen, const Eigen::Ref<const Eigen::VectorXd>& goal, double radius,
             Eigen::Ref<Eigen::MatrixXd> plan) const;

 private:
  void build_gains(const Eigen::MatrixXd& zeta, const ElteWeights& weights);
  void build_tables();
  void fill_response(Eigen::Index block, Eigen::Index end);
  void fill_offset(Eigen::Index block, Eigen::Index end, Eigen::Index j);
  void check(Eigen::Index frozen, const Eigen::Ref<const Eigen::VectorXd>& goal, double radius,
             const Eigen::Ref<const Eigen::MatrixXd>& plan) const;
  void roll_out(Eigen::Index frozen, double end, Eigen::Index dimension, double* plan) const;

  // Index k: the step from node k to node k+1, taken in the state (v_k, e_k).
  Eigen::VectorXd step_gain_;   // Kv
  Eigen::VectorXd error_gain_;  // Ke
  Eigen::MatrixXd feed_;        // kff, per dimension

  // Best free end point: e* = best_error_gain_ v + best_error_feed_.
  Eigen::VectorXd best_error_gain_;
  Eigen::MatrixXd best_error_feed_;

  // e_k and v_k as (from_step v_b + from_error e_b + offset), b the
  // block's first node.
  struct Table {
    Eigen::VectorXd from_step;
    Eigen::VectorXd from_error;
    Eigen::MatrixXd offset;  // per dimension
  };
  Table error_;
  Table step_;
};

}  // namespace elte_planner
