// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/elastic_map_skill_planner.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <vector>

#include "frame_displacement.hpp"

namespace elte_planner {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// I + w_E E'E + w_R R'R.
Sparse hessian(Eigen::Index n, const ElteWeights& weights) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&entries](Eigen::Index first, const std::vector<double>& row, double weight) {
    for (std::size_t a = 0; a < row.size(); ++a) {
      for (std::size_t b = 0; b < row.size(); ++b) {
        entries.emplace_back(static_cast<int>(first) + static_cast<int>(a),
                             static_cast<int>(first) + static_cast<int>(b),
                             weight * row[a] * row[b]);
      }
    }
  };
  for (Eigen::Index k = 0; k < n; ++k) {
    add(k, {1.0}, 1.0);
    if (k + 1 < n) add(k, {-1.0, 1.0}, weights.elastic);
    if (k + 2 < n) add(k, {1.0, -2.0, 1.0}, weights.bending);
  }
  Sparse matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

ElasticMapSkillPlanner::ElasticMapSkillPlanner(const Eigen::MatrixXd& demonstration,
                                               const ElteWeights& weights)
    : demonstration_(demonstration), weights_(weights) {
  validate_demonstration_nodes(demonstration);
  weights.validate();
}

// The cost of moving the last node, all others following, is isotropic: its best place in the ball
// is the projection of the best free one, and the others follow along H^-1 e_last.
PlanResult ElasticMapSkillPlanner::plan(const PlanRequest& request) {
  validate_request(request, demonstration_);
  refuse_obstacles(request, name());
  const Eigen::Index n = demonstration_.rows();
  if (request.frozen == n) return all_frozen(request);
  const Eigen::Index free = n - request.frozen;
  const Sparse full = hessian(n, weights_);
  const Sparse free_block = full.bottomRightCorner(free, free);
  const Eigen::MatrixXd places = demonstration_ + frame_displacement(request, demonstration_);
  const Eigen::MatrixXd right =
      places.bottomRows(free) -
      full.bottomLeftCorner(free, request.frozen) * request.previous.topRows(request.frozen);
  const Eigen::SimplicialLDLT<Sparse> factor(free_block);

  Eigen::MatrixXd y = factor.solve(right);
  const Eigen::VectorXd response = factor.solve(Eigen::VectorXd::Unit(free, free - 1));
  Eigen::VectorXd end = y.row(free - 1).transpose();
  project_on_l1_ball(request.goal, request.radius, end);
  y += response / response[free - 1] * (end.transpose() - y.row(free - 1));
  y.row(free - 1) = end.transpose();

  PlanResult result;
  result.status = PlanStatus::kSolved;
  result.positions = request.previous;
  result.positions.bottomRows(free) = y;
  const Eigen::MatrixXd half_gradient = free_block * y - right;
  Eigen::VectorXd stepped = end - half_gradient.row(free - 1).transpose();
  project_on_l1_ball(request.goal, request.radius, stepped);
  result.kkt_residual = (end - stepped).cwiseAbs().maxCoeff();
  if (free > 1) {
    result.kkt_residual =
        std::max(result.kkt_residual, half_gradient.topRows(free - 1).cwiseAbs().maxCoeff());
  }
  return result;
}

}  // namespace elte_planner
