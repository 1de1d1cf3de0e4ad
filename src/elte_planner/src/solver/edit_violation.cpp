// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "edit_workspace.hpp"

namespace elte_planner {

double violation_of(const PointConstraint& c, const Eigen::MatrixXd& y) {
  const auto offset = y.row(c.node).transpose() - c.centre;
  switch (c.shape) {
    case PointConstraint::Shape::kBox:
      return (offset.cwiseAbs() - c.half_widths).maxCoeff();
    case PointConstraint::Shape::kHalfSpace:
      return c.normal.dot(offset) / c.normal.norm();
    case PointConstraint::Shape::kBall:
      break;
  }
  return offset.lpNorm<1>() - c.radius;
}

void EditSolver::Workspace::offer_ball(int constraint, Eigen::Index index, bool on_step,
                                       double radius, double& worst, Facet& best) {
  const auto centre = [&](Eigen::Index j) { return on_step ? 0.0 : centres_(constraint, j); };
  const auto offset_from_centre = [&](Eigen::Index j) {
    const double x = on_step ? y_(index, j) - y_(index - 1, j) : y_(index, j);
    return x - centre(j);
  };
  double norm = 0.0;
  for (Eigen::Index j = 0; j < d_; ++j) norm += std::abs(offset_from_centre(j));
  if (norm - radius <= worst) return;
  worst = norm - radius;
  double offset = radius;
  for (Eigen::Index j = 0; j < d_; ++j) {
    best_normal_[j] = offset_from_centre(j) < 0.0 ? -1.0 : 1.0;
    offset += best_normal_[j] * centre(j);
  }
  best = Facet{};
  best.index = index;
  best.on_step = on_step;
  best.constraint = constraint;
  best.offset = offset;
}

void EditSolver::Workspace::offer_box(int constraint, double& worst, Facet& best) {
  const PointConstraint& c = problem_->constraints[static_cast<std::size_t>(constraint)];
  for (Eigen::Index j = 0; j < d_; ++j) {
    const double x = y_(c.node, j) - centres_(constraint, j);
    const double excess = std::abs(x) - c.half_widths[j];
    if (c.half_widths[j] == 0.0 || !(excess > worst)) continue;
    worst = excess;
    const double sign = x < 0.0 ? -1.0 : 1.0;
    best_normal_.setZero();
    best_normal_[j] = sign;
    best = Facet{};
    best.index = c.node;
    best.constraint = constraint;
    best.offset = sign * centres_(constraint, j) + c.half_widths[j];
  }
}

void EditSolver::Workspace::offer_half_space(int constraint, double& worst, Facet& best) {
  const PointConstraint& c = problem_->constraints[static_cast<std::size_t>(constraint)];
  const double length = c.normal.norm();
  double excess = 0.0;
  double offset = 0.0;
  for (Eigen::Index j = 0; j < d_; ++j) {
    trial_normal_[j] = c.normal[j] / length;
    excess += trial_normal_[j] * (y_(c.node, j) - centres_(constraint, j));
    offset += trial_normal_[j] * centres_(constraint, j);
  }
  if (excess <= worst) return;
  worst = excess;
  best_normal_ = trial_normal_;
  best = Facet{};
  best.index = c.node;
  best.constraint = constraint;
  best.offset = offset;
}

bool EditSolver::Workspace::most_violated(Facet& facet, double& violation) {
  double worst = tolerance_;
  const auto& constraints = problem_->constraints;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const PointConstraint& c = constraints[i];
    if (c.node < fixed_rows_ || is_equality(c)) continue;
    switch (c.shape) {
      case PointConstraint::Shape::kBall:
        offer_ball(static_cast<int>(i), c.node, false, c.radius, worst, facet);
        break;
      case PointConstraint::Shape::kBox:
        offer_box(static_cast<int>(i), worst, facet);
        break;
      case PointConstraint::Shape::kHalfSpace:
        offer_half_space(static_cast<int>(i), worst, facet);
    }
  }
  if (!std::isinf(problem_->max_step) || !std::isinf(problem_->max_first_step)) {
    const auto count = static_cast<int>(constraints.size());
    for (Eigen::Index i = chain_.first_step(); i < n_; ++i) {
      const double bound = i == chain_.first_step()
                               ? std::min(problem_->max_step, problem_->max_first_step)
                               : problem_->max_step;
      if (!std::isinf(bound)) offer_ball(count, i, true, bound, worst, facet);
    }
  }
  violation = worst;
  return worst > tolerance_;
}

}  // namespace elte_planner
