// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "edit_workspace.hpp"

namespace elte_planner {

std::string EditSolver::Workspace::name_of(int constraint) const {
  const auto index = static_cast<std::size_t>(constraint);
  if (index >= problem_->constraints.size()) return "the step bound";
  return "constraint " + std::to_string(constraint) + " on node " +
         std::to_string(problem_->constraints[index].node);
}

void EditSolver::Workspace::name_contradiction(EditSolution& solution) const {
  std::vector<int> involved;
  for (Eigen::Index a = 0; a < active_.size(); ++a) {
    if (std::abs(active_.direction(a)) > 1e-9) involved.push_back(active_[a].constraint);
  }
  std::sort(involved.begin(), involved.end());
  involved.erase(std::unique(involved.begin(), involved.end()), involved.end());
  solution.message = name_of(active_.candidate().constraint) + " contradicts ";
  if (involved.empty()) solution.message += "the fixed rows";
  for (std::size_t i = 0; i < involved.size(); ++i) {
    solution.message += (i > 0 ? " and " : "") + name_of(involved[i]);
  }
}

void EditSolver::Workspace::report(EditSolution& solution) {
  solution.active.clear();
  solution.y = y_.rowwise() + origin_;
  solution.y.topRows(fixed_rows_) = problem_->fixed;
  solution.forces.setZero(centres_.rows(), d_);
  for (Eigen::Index a = 0; a < active_.size(); ++a) {
    const Facet& facet = active_[a];
    if (facet.constraint >= solution.forces.rows()) continue;
    solution.forces.row(facet.constraint) += 2.0 * facet.multiplier * active_.normal(a).transpose();
    solution.active.push_back(facet.constraint);
  }
  std::sort(solution.active.begin(), solution.active.end());
  solution.active.erase(std::unique(solution.active.begin(), solution.active.end()),
                        solution.active.end());
  for (const int i : solution.active) {
    const PointConstraint& c = problem_->constraints[static_cast<std::size_t>(i)];
    if (is_equality(c)) solution.y.row(c.node) = c.centre.transpose();
  }
  solution.active_facets = static_cast<int>(active_.size());
  solution.energy = energy(problem_->zeta, problem_->weights, solution.y);
  solution.kkt_residual = residual(solution);
}

// Many constraints close together with weak elasticity leave the positions, sums of steps, with an
// error that the gradient sees. One Newton step of the optimality conditions on the active set,
// from the gradient itself, removes it; kept only while it helps.
void EditSolver::Workspace::refine(EditSolution& solution) {
  constexpr int kMaxPasses = 4;
  const double good_enough = 1e-14 * extent_ * (1.0 + problem_->weights.curvature());
  for (int pass = 0; pass < kMaxPasses && solution.kkt_residual > good_enough; ++pass) {
    solution_before_ = solution;
    y_before_ = y_;
    facets_before_ = active_.facets();
    newton_step();
    report(solution);
    if (solution.kkt_residual < 0.5 * solution_before_.kkt_residual) continue;
    solution = solution_before_;
    y_ = y_before_;
    active_.set_multipliers(facets_before_);
    return;
  }
}

void EditSolver::Workspace::newton_step() {
  const Eigen::Index first = chain_.first_step();
  absolute_ = y_.rowwise() + origin_;
  compute_gradient(absolute_);
  displacement_.setZero(d_);
  for (Eigen::Index j = 0; j < d_; ++j) {
    double sum = 0.0;
    for (Eigen::Index i = n_ - 1; i >= first; --i) steps_(i, j) = sum -= gradient_(i, j);
    if (!chain_.start_is_free()) continue;
    displacement_[j] = (sum - gradient_(0, j)) / chain_.proximal_weight();
    y_(0, j) += displacement_[j];
  }
  chain_.solve(steps_);
  for (Eigen::Index j = 0; j < d_; ++j) {
    for (Eigen::Index i = first; i < n_; ++i) y_(i, j) += displacement_[j] += steps_(i, j);
  }
  values_.resize(std::max<Eigen::Index>(values_.size(), active_.size()));
  for (Eigen::Index a = 0; a < active_.size(); ++a) values_[a] = violation_of(active_[a], a);
  active_.solve_gram(values_);
  for (Eigen::Index a = 0; a < active_.size(); ++a) {
    active_[a].multiplier += values_[a];
    const Eigen::Index count = n_ - first + 1;
    for (Eigen::Index j = 0; j < d_; ++j) {
      const double weight = values_[a] * active_.normal(a)[j];
      y_.col(j).tail(count) -= weight * active_.column(a).tail(count);
    }
  }
}

void EditSolver::Workspace::compute_gradient(const Eigen::MatrixXd& y) {
  gradient_.setZero(n_, d_);
  half_gradient(problem_->zeta, problem_->weights, y, fixed_rows_, gradient_);
  for (Eigen::Index a = 0; a < active_.size(); ++a) {
    const Facet& facet = active_[a];
    const auto force = facet.multiplier * active_.normal(a).transpose();
    gradient_.row(facet.index) += force;
    if (facet.on_step) gradient_.row(facet.index - 1) -= force;
  }
}

// From the positions as returned and the gradient of J itself, not from the method's own numbers.
double EditSolver::Workspace::residual(const EditSolution& solution) {
  compute_gradient(solution.y);
  double worst = 0.0;
  for (Eigen::Index a = 0; a < active_.size(); ++a) {
    const Facet& facet = active_[a];
    if (!facet.equality) worst = std::max(worst, -facet.multiplier);
    worst = std::max(worst, std::abs(violation_of(facet, a)));
  }
  if (fixed_rows_ < n_) {
    worst = std::max(worst, gradient_.bottomRows(n_ - fixed_rows_).cwiseAbs().maxCoeff());
  }
  for (const PointConstraint& c : problem_->constraints) {
    worst = std::max(worst, elte_planner::violation_of(c, solution.y));
  }
  for (Eigen::Index i = chain_.first_step(); i < n_; ++i) {
    const double step = (solution.y.row(i) - solution.y.row(i - 1)).lpNorm<1>();
    worst = std::max(worst, step - problem_->max_step);
    if (i == chain_.first_step()) worst = std::max(worst, step - problem_->max_first_step);
  }
  return worst;
}

}  // namespace elte_planner
