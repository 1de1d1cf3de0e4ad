// SPDX-License-Identifier: BSD-3-Clause
//
// The energy of elastic Laplacian trajectory editing and its optimality conditions.
//
//   J(y) = |L(y - zeta)|^2 + w_E |E y|^2 + w_R |R y|^2
//
// y and zeta (the demonstration) are N nodes x d dimensions, E is the first difference, R the
// second difference (rows [1 -2 1]). L is the graph Laplacian of the chain: -R/2 at the inner
// nodes. At the two end nodes it is nothing or the one-sided difference; ElteWeights::laplacian
// chooses. All weights are per node and without unit.
#pragma once

#include <Eigen/Core>

namespace elte_planner {

enum class Laplacian {
  kFreeEnds,       // inner rows only, as the published code of ELTE's authors
  kRowNormalised,  // with end rows y0-y1 and y_{N-1}-y_{N-2}: keeps the tangents at the ends
};

struct ElteWeights {
  double elastic = 0.001;  // w_E
  double bending = 0.001;  // w_R
  Laplacian laplacian = Laplacian::kFreeEnds;

  void validate() const;                               // throws std::invalid_argument
  double curvature() const { return 0.25 + bending; }  // total weight of |R y|^2

  // Number of nodes over which a disturbance decays; a demonstration much longer than this is
  // pulled toward a straight line.
  double decay_nodes() const;
};

// Coordinates beyond it are refused like infinite ones, so that their squares and sums are finite.
constexpr double kMaxMagnitude = 1e100;
[[nodiscard]] bool is_within_magnitude(const Eigen::Ref<const Eigen::MatrixXd>& values);

// Throws unless zeta has at least 3 nodes, 1 dimension and only values within the magnitude.
void validate_demonstration_nodes(const Eigen::Ref<const Eigen::MatrixXd>& zeta);

[[nodiscard]] double energy(const Eigen::Ref<const Eigen::MatrixXd>& zeta,
                            const ElteWeights& weights, const Eigen::Ref<const Eigen::MatrixXd>& y);

// Half the gradient of J at one node and dimension.
[[nodiscard]] double half_gradient(const Eigen::Ref<const Eigen::MatrixXd>& zeta,
                                   const ElteWeights& weights,
                                   const Eigen::Ref<const Eigen::MatrixXd>& y, Eigen::Index node,
                                   Eigen::Index dimension);

// The same at all nodes from `from` on, in their rows of `result` (nodes x dimensions).
void half_gradient(const Eigen::Ref<const Eigen::MatrixXd>& zeta, const ElteWeights& weights,
                   const Eigen::Ref<const Eigen::MatrixXd>& y, Eigen::Index from,
                   Eigen::MatrixXd& result);

// Euclidean projection of `point` on {x : |x - centre|_1 <= radius}, in place, no allocation.
void project_on_l1_ball(const Eigen::Ref<const Eigen::VectorXd>& centre, double radius,
                        Eigen::Ref<Eigen::VectorXd, 0, Eigen::InnerStride<>> point);

// KKT residual of minimising J over the rows from `frozen` on, the last one within `radius` of
// `goal` in the l1 norm: the largest |y_k - Proj_k(y_k - grad_k J / 2)|, in the unit of y.
[[nodiscard]] double endpoint_kkt_residual(const Eigen::Ref<const Eigen::MatrixXd>& zeta,
                                           const ElteWeights& weights,
                                           const Eigen::Ref<const Eigen::MatrixXd>& y,
                                           Eigen::Index frozen,
                                           const Eigen::Ref<const Eigen::VectorXd>& goal,
                                           double radius);

// Share of the demonstration's shape that the weights alone remove when only both ends are kept:
// largest displacement of a node over the largest distance from the chord. 0: nothing is lost; 1:
// the plan is a straight line. 0 for a demonstration that is straight itself.
[[nodiscard]] double shape_loss(const Eigen::MatrixXd& zeta, const ElteWeights& weights);

}  // namespace elte_planner
