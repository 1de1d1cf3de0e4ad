// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/endpoint_solver.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "block_roll_out.hpp"

namespace elte_planner {

EndpointSolver::EndpointSolver(const Eigen::MatrixXd& zeta, const ElteWeights& weights) {
  validate_demonstration_nodes(zeta);
  weights.validate();
  build_gains(zeta, weights);
  build_tables();
}

// Backward over the steps k -> k+1 with the cost to go
//   V_k(v, e) = A v^2 - 2 B v e + C e^2 + a v + c e   and   det = A C - B^2.
// Every term of the recursion is positive: nothing is subtracted from its like.
void EndpointSolver::build_gains(const Eigen::MatrixXd& zeta, const ElteWeights& weights) {
  const Eigen::Index n = zeta.rows();
  const Eigen::Index d = zeta.cols();
  const double q = weights.curvature();
  const double w = weights.elastic;
  const bool end_row = weights.laplacian == Laplacian::kRowNormalised;

  for (Eigen::VectorXd* gain : {&step_gain_, &error_gain_, &best_error_gain_}) gain->setZero(n);
  for (Eigen::MatrixXd* feed : {&feed_, &best_error_feed_}) feed->setZero(n, d);

  const auto half_second_difference = [&zeta](Eigen::Index k, Eigen::Index j) {
    return 0.5 * ((zeta(k + 1, j) - zeta(k, j)) - (zeta(k, j) - zeta(k - 1, j)));
  };

  // The last step has no choice: it goes to the end point.
  double A = q;
  double B = q;
  double C = q + w + (end_row ? 1.0 : 0.0);
  double det = q * (C - q);
  Eigen::VectorXd a(d);
  Eigen::VectorXd c(d);
  for (Eigen::Index j = 0; j < d; ++j) {
    a[j] = half_second_difference(n - 2, j);
    c[j] = -a[j];
    if (end_row) c[j] -= 2.0 * (zeta(n - 1, j) - zeta(n - 2, j));
  }
  error_gain_[n - 2] = 1.0;

  for (Eigen::Index k = n - 2;; --k) {
    best_error_gain_[k] = B / C;
    best_error_feed_.row(k) = (-0.5 / C) * c.transpose();
    if (k == 1) break;
    const double S = w + A + 2.0 * B + C;
    const double inverse_W = 1.0 / (q + S);
    const double Kv = q * inverse_W;
    const double Ke = (C + B) * inverse_W;
    step_gain_[k - 1] = Kv;
    error_gain_[k - 1] = Ke;
    for (Eigen::Index j = 0; j < d; ++j) {
      const double h = half_second_difference(k - 1, j);
      const double g = h - a[j] + c[j];
      feed_(k - 1, j) = 0.5 * g * inverse_W;
      a[j] = h - Kv * g;
      c[j] -= Ke * g;
    }
    const double next_det = q * (C * w + det) * inverse_W;
    A = q * S * inverse_W;
    B = q * Ke;
    C = (C * (q + w) + det) * inverse_W;
    det = next_det;
  }
}

void EndpointSolver::build_tables() {
  const Eigen::Index n = nodes();
  const Eigen::Index d = dimensions();
  for (Table* table : {&error_, &step_}) {
    table->from_step.setZero(n);
    table->from_error.setZero(n);
    table->offset.setZero(n, d);
  }
  for (Eigen::Index block = 1; block < n - 1; block += kRollOutBlock) {
    const Eigen::Index end = std::min(block + kRollOutBlock, n - 1);
    fill_response(block, end);
    for (Eigen::Index j = 0; j < d; ++j) fill_offset(block, end, j);
  }
}

// To a unit step and, beside it, to a unit error at the block's first node, nothing being fed.
void EndpointSolver::fill_response(Eigen::Index block, Eigen::Index end) {
  double step_v = 1.0;
  double step_e = 0.0;
  double error_v = 0.0;
  double error_e = 1.0;
  for (Eigen::Index k = block; k < end; ++k) {
    step_v = step_gain_[k] * step_v + error_gain_[k] * step_e;
    step_e -= step_v;
    error_v = step_gain_[k] * error_v + error_gain_[k] * error_e;
    error_e -= error_v;
    step_.from_step[k + 1] = step_v;
    error_.from_step[k + 1] = step_e;
    step_.from_error[k + 1] = error_v;
    error_.from_error[k + 1] = error_e;
  }
}

void EndpointSolver::fill_offset(Eigen::Index block, Eigen::Index end, Eigen::Index j) {
  double v = 0.0;
  double e = 0.0;
  for (Eigen::Index k = block; k < end; ++k) {
    v = step_gain_[k] * v + error_gain_[k] * e + feed_(k, j);
    e -= v;
    step_.offset(k + 1, j) = v;
    error_.offset(k + 1, j) = e;
  }
}

void EndpointSolver::check(Eigen::Index frozen, const Eigen::Ref<const Eigen::VectorXd>& goal,
                           double radius, const Eigen::Ref<const Eigen::MatrixXd>& plan) const {
  if (plan.rows() != nodes() || plan.cols() != dimensions() || goal.size() != dimensions()) {
    throw std::invalid_argument("plan is " + std::to_string(plan.rows()) + " x " +
                                std::to_string(plan.cols()) + " and goal has " +
                                std::to_string(goal.size()) + " coordinates, must be " +
                                std::to_string(nodes()) + " x " + std::to_string(dimensions()));
  }
  if (frozen < kMinFrozen || frozen >= nodes()) {
    throw std::invalid_argument("frozen is " + std::to_string(frozen) + ", must be within [2, " +
                                std::to_string(nodes() - 1) + "]");
  }
  if (!std::isfinite(radius) || radius < 0.0) {
    throw std::invalid_argument("radius is " + std::to_string(radius) +
                                ", must be finite and at least 0");
  }
  if (!is_within_magnitude(goal) || !is_within_magnitude(plan.middleRows(frozen - 2, 2))) {
    throw std::invalid_argument(
        "goal or last frozen rows have a value that is not finite or above 1e100");
  }
}

void EndpointSolver::solve(Eigen::Index frozen, const Eigen::Ref<const Eigen::VectorXd>& goal,
                           double radius, Eigen::Ref<Eigen::MatrixXd> plan) const {
  check(frozen, goal, radius, plan);
  const Eigen::Index k = frozen - 1;
  auto end = plan.row(nodes() - 1);
  for (Eigen::Index j = 0; j < dimensions(); ++j) {
    const double step = plan(k, j) - plan(k - 1, j);
    end[j] = plan(k, j) + best_error_gain_[k] * step + best_error_feed_(k, j);
  }
  project_on_l1_ball(goal, radius, end.transpose());
  for (Eigen::Index j = 0; j < dimensions(); ++j) {
    roll_out(frozen, end[j], j, plan.col(j).data());
  }
}

void EndpointSolver::roll_out(Eigen::Index frozen, double end, Eigen::Index dimension,
                              double* plan) const {
  const Eigen::Index last = nodes() - 1;
  Eigen::Index k = frozen - 1;
  double v = plan[k] - plan[k - 1];
  double e = end - plan[k];
  for (; k < last && (k - 1) % kRollOutBlock != 0; ++k) {
    v = step_gain_[k] * v + error_gain_[k] * e + feed_(k, dimension);
    e -= v;
    plan[k + 1] = end - e;
  }
  roll_out_blocks(
      {error_.from_step.data(), error_.from_error.data(), error_.offset.col(dimension).data(),
       step_.from_step.data(), step_.from_error.data(), step_.offset.col(dimension).data()},
      k, last, v, e, end, plan);
}

}  // namespace elte_planner
