// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "edit_workspace.hpp"

namespace elte_planner {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of the proximal term, see edit_proximal.cpp. With one weight about one in a thousand problems
// does not settle; it goes on with the next from where it stands.
constexpr double kProximalWeights[] = {1e-3, 1e-5, 1e-1, 1e-7};

}  // namespace

void EditSolver::Workspace::solve(const EditProblem& problem, const EditParams& params,
                                  EditSolution& solution) {
  problem.validate();
  problem_ = &problem;
  params_ = &params;
  solution.message.clear();
  solution.active.clear();
  solution.iterations = 0;
  solution.active_facets = 0;
  prepare();
  chain_.factorise(n_, problem_->weights, fixed_rows_, kProximalWeights[0]);
  solution.message = ill_posed_reason();
  if (!solution.message.empty()) {
    solution.status = EditStatus::kIllPosed;
    solution.y.resize(0, 0);
    return;
  }
  if (!fixed_rows_are_feasible(solution)) {
    solution.status = EditStatus::kInfeasible;
    solution.y.resize(0, 0);
    return;
  }
  for (const double weight : kProximalWeights) {
    chain_.factorise(n_, problem_->weights, fixed_rows_, weight);
    solve_from_here(solution);
    if (!chain_.is_proximal() || solution.status != EditStatus::kIterationLimit) return;
  }
}

void EditSolver::Workspace::solve_from_here(EditSolution& solution) {
  solution.message.clear();
  iteration_limit_ = solution.iterations + params_->max_iterations;
  last_centre_step_ = kInfinity;
  centre_step_.resize(0);
  SolveResult result = solve_strictly_convex(solution);
  constexpr int kMaxNewtonSteps = 100;
  for (int step = 0; step < kMaxNewtonSteps && result == SolveResult::kDone; ++step) {
    if (!chain_.is_proximal() || !move_proximal_centre()) break;
    result = solve_strictly_convex(solution);
  }
  solution.status = result == SolveResult::kDone         ? EditStatus::kSolved
                    : result == SolveResult::kInfeasible ? EditStatus::kInfeasible
                                                         : EditStatus::kIterationLimit;
  if (result != SolveResult::kDone) {
    solution.y.resize(0, 0);
    if (solution.message.empty()) {
      solution.message = "not solved within " + std::to_string(params_->max_iterations) +
                         " changes of the active set";
    }
    return;
  }
  report(solution);
  refine(solution);
  const ElteWeights& weights = problem_->weights;
  if (!(solution.kkt_residual <= 1e-8 * extent_ * (weights.curvature() + weights.elastic))) {
    solution.status = EditStatus::kIterationLimit;
    solution.message = "optimality is missed by " + std::to_string(solution.kkt_residual);
  }
}

void EditSolver::Workspace::prepare() {
  n_ = problem_->zeta.rows();
  d_ = problem_->zeta.cols();
  fixed_rows_ = problem_->fixed.rows();
  origin_ = fixed_rows_ > 0 ? problem_->fixed.row(fixed_rows_ - 1) : problem_->zeta.row(0);
  const auto& constraints = problem_->constraints;
  centres_.resize(static_cast<Eigen::Index>(constraints.size()), d_);
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    centres_.row(static_cast<Eigen::Index>(i)) = constraints[i].centre.transpose() - origin_;
  }
  y_.resize(n_, d_);
  steps_.resize(n_, d_);
  right_.resize(n_, d_);
  best_normal_.resize(d_);
  trial_normal_.resize(d_);
  start_ = problem_->zeta.row(0) - origin_;
  slope_ = problem_->zeta.row(1) - problem_->zeta.row(0);
  extent_ = (problem_->zeta.rowwise() - problem_->zeta.row(0)).cwiseAbs().maxCoeff();
  if (centres_.size() > 0) extent_ = std::max(extent_, centres_.cwiseAbs().maxCoeff());
  if (extent_ == 0.0) extent_ = 1.0;
}

std::string EditSolver::Workspace::ill_posed_reason() const {
  if (fixed_rows_ > 1 || fixed_rows_ == n_ || !chain_.is_proximal()) return {};
  Eigen::Index held = fixed_rows_;
  Eigen::Index last_node = -1;
  for (const PointConstraint& c : problem_->constraints) {
    if (c.node >= fixed_rows_ && c.node != last_node) ++held;
    last_node = c.node;
  }
  if (held == 0) return "no row is fixed and no node constrained: the position is not determined";
  if (held == 1 && chain_.slope_is_free()) {
    return "one node is held and w_elastic is 0: the slope is not determined";
  }
  return {};
}

bool EditSolver::Workspace::fixed_rows_are_feasible(EditSolution& solution) const {
  for (std::size_t i = 0; i < problem_->constraints.size(); ++i) {
    const PointConstraint& c = problem_->constraints[i];
    if (c.node >= fixed_rows_) continue;
    const double excess = elte_planner::violation_of(c, problem_->fixed);
    if (excess > params_->tolerance * extent_ + 1e-15 * c.centre.cwiseAbs().maxCoeff()) {
      solution.message = name_of(static_cast<int>(i)) + " is violated by " +
                         std::to_string(excess) + " at a fixed row";
      return false;
    }
  }
  return true;
}

// b_i of the equations H v = b that hold at the unconstrained minimum.
void EditSolver::Workspace::build_right_side() {
  const Eigen::MatrixXd& zeta = problem_->zeta;
  const double q = problem_->weights.curvature();
  const bool end_rows = problem_->weights.laplacian == Laplacian::kRowNormalised;
  const Eigen::Index first = chain_.first_step();
  for (Eigen::Index j = 0; j < d_; ++j) {
    const auto demonstrated_step = [&](Eigen::Index i) { return zeta(i, j) - zeta(i - 1, j); };
    for (Eigen::Index i = first; i < n_; ++i) {
      double b = 0.0;
      if (i > 1) b += 0.25 * (demonstrated_step(i) - demonstrated_step(i - 1));
      if (i < n_ - 1) b -= 0.25 * (demonstrated_step(i + 1) - demonstrated_step(i));
      if (end_rows && (i == 1 || i == n_ - 1)) b += demonstrated_step(i);
      right_(i, j) = b;
    }
    if (fixed_rows_ > 1) {
      const auto& fixed = problem_->fixed;
      right_(first, j) += q * (fixed(first - 1, j) - fixed(first - 2, j));
    }
    if (chain_.slope_is_free()) right_(1, j) += chain_.proximal_weight() * slope_[j];
  }
}

EditSolver::Workspace::SolveResult EditSolver::Workspace::solve_strictly_convex(
    EditSolution& solution) {
  for (Eigen::Index k = 0; k < fixed_rows_; ++k) y_.row(k) = problem_->fixed.row(k) - origin_;
  active_.reset(&chain_, n_, d_);
  if (fixed_rows_ == n_) return SolveResult::kDone;
  build_right_side();
  recompute_from_multipliers();
  SolveResult result = SolveResult::kDone;
  if (!add_equalities(solution, result)) return result;
  // Violations below the rounding of the positions make facets come and go for ever: a round that
  // takes too long ends, and the next one asks for less.
  constexpr int kMaxRounds = 20;
  tolerance_ = params_->tolerance * extent_;
  for (int round = 0; round < kMaxRounds; ++round) {
    const int before = solution.iterations;
    const int patience = 300 + 30 * static_cast<int>(active_.size() + problem_->constraints.size());
    result = add_violated(patience, solution);
    if (result != SolveResult::kDone) return result;
    if (round > 0 && solution.iterations == before) return SolveResult::kDone;
    if (solution.iterations - before > patience) tolerance_ *= 10.0;
    polish();
  }
  return SolveResult::kDone;
}

// Steps and positions of the minimiser of the Lagrangian at the present multipliers.
void EditSolver::Workspace::recompute_from_multipliers() {
  const Eigen::Index first = chain_.first_step();
  steps_.setZero();
  for (Eigen::Index a = 0; a < active_.size(); ++a) {
    const Facet& facet = active_[a];
    if (!facet.on_step) steps_.row(facet.index) -= facet.multiplier * active_.normal(a).transpose();
  }
  for (Eigen::Index j = 0; j < d_; ++j) {
    double force = 0.0;
    double* b = steps_.col(j).data();
    for (Eigen::Index i = n_ - 1; i >= first; --i) {
      force += b[i];
      b[i] = right_(i, j) + force;
    }
    if (chain_.start_is_free()) {
      y_(0, j) = start_[j] + (force + b[0]) / chain_.proximal_weight();
    }
  }
  for (Eigen::Index a = 0; a < active_.size(); ++a) {
    const Facet& facet = active_[a];
    if (facet.on_step) steps_.row(facet.index) -= facet.multiplier * active_.normal(a).transpose();
  }
  chain_.solve(steps_);
  for (Eigen::Index j = 0; j < d_; ++j) {
    for (Eigen::Index i = first; i < n_; ++i) y_(i, j) = y_(i - 1, j) + steps_(i, j);
  }
}

double EditSolver::Workspace::violation_of(const Facet& facet, Eigen::Index normal) const {
  double value = -facet.offset;
  for (Eigen::Index j = 0; j < d_; ++j) {
    const double x =
        facet.on_step ? y_(facet.index, j) - y_(facet.index - 1, j) : y_(facet.index, j);
    value += active_.normal(normal)[j] * x;
  }
  return value;
}

// Iterative refinement: the residual of the active facets is computed from fresh positions, until
// it no longer halves.
void EditSolver::Workspace::polish() {
  constexpr int kMaxPasses = 10;
  values_.resize(std::max<Eigen::Index>(values_.size(), active_.size()));
  auto residuals = values_.head(active_.size());
  double previous = kInfinity;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    recompute_from_multipliers();
    if (active_.size() == 0) return;
    for (Eigen::Index a = 0; a < active_.size(); ++a) residuals[a] = violation_of(active_[a], a);
    const double largest = residuals.cwiseAbs().maxCoeff();
    if (largest <= 1e-16 * extent_ || !(largest < 0.5 * previous)) return;
    previous = largest;
    active_.solve_gram(values_);
    for (Eigen::Index a = 0; a < active_.size(); ++a) active_[a].multiplier += residuals[a];
  }
}

bool EditSolver::Workspace::add_equalities(EditSolution& solution, SolveResult& result) {
  for (std::size_t i = 0; i < problem_->constraints.size(); ++i) {
    const PointConstraint& c = problem_->constraints[i];
    if (c.node < fixed_rows_) continue;
    for (Eigen::Index j = 0; j < d_; ++j) {
      const bool box = c.shape == PointConstraint::Shape::kBox;
      if (!(is_equality(c) || (box && c.half_widths[j] == 0.0))) continue;
      Facet facet;
      facet.index = c.node;
      facet.equality = true;
      facet.constraint = static_cast<int>(i);
      const double missing = y_(c.node, j) - centres_(static_cast<Eigen::Index>(i), j);
      const double sign = missing < 0.0 ? -1.0 : 1.0;
      facet.offset = sign * centres_(static_cast<Eigen::Index>(i), j);
      best_normal_.setZero();
      best_normal_[j] = sign;
      active_.propose(facet, best_normal_);
      if (active_.depends_on_active_facets_of_its_node()) {
        if (std::abs(missing) <= 1e-9 * extent_) continue;  // said twice
        name_contradiction(solution);
        result = SolveResult::kInfeasible;
        return false;
      }
      result = enter(std::abs(missing), solution);
      if (result != SolveResult::kDone) return false;
    }
  }
  return true;
}

EditSolver::Workspace::SolveResult EditSolver::Workspace::add_violated(int patience,
                                                                       EditSolution& solution) {
  Facet facet;
  double violation = 0.0;
  const int limit = solution.iterations + patience;
  while (solution.iterations <= limit && most_violated(facet, violation)) {
    active_.propose(facet, best_normal_);
    const SolveResult result = enter(violation, solution);
    if (result != SolveResult::kDone) return result;
  }
  return SolveResult::kDone;
}

// One constraint's way into the active set: full steps in primal and dual space, or as far as a
// multiplier stays positive, after which its facet leaves.
EditSolver::Workspace::SolveResult EditSolver::Workspace::enter(double violation,
                                                                EditSolution& solution) {
  const bool node_only = std::isinf(problem_->max_step) && std::isinf(problem_->max_first_step);
  double multiplier = 0.0;
  for (;;) {
    if (++solution.iterations > iteration_limit_) return SolveResult::kIterationLimit;
    // Facets of different nodes never depend on each other; with step bounds they can.
    const bool dependent = active_.depends_on_active_facets_of_its_node() ||
                           (!node_only && active_.pivot() <= 1e-11 * active_.own_product());
    double blocking = kInfinity;
    Eigen::Index leaving = -1;
    for (Eigen::Index a = 0; a < active_.size(); ++a) {
      const double rate = active_.direction(a);
      if (active_[a].equality || rate <= 1e-12) continue;
      const double limit = std::max(active_[a].multiplier, 0.0) / rate;
      if (limit < blocking) {
        blocking = limit;
        leaving = a;
      }
    }
    const double full = dependent ? kInfinity : violation / active_.pivot();
    const double step = std::min(full, blocking);
    if (std::isinf(step)) {
      name_contradiction(solution);
      return SolveResult::kInfeasible;
    }
    if (!dependent) active_.move(step, y_);
    for (Eigen::Index a = 0; a < active_.size(); ++a) {
      active_[a].multiplier -= step * active_.direction(a);
    }
    multiplier += step;
    if (full <= blocking) {
      active_.accept(multiplier);
      return SolveResult::kDone;
    }
    if (!dependent) violation -= step * active_.pivot();
    active_.drop(leaving);
    active_.update_direction();
  }
}

EditSolver::EditSolver() : workspace_(std::make_unique<Workspace>()) {}
EditSolver::~EditSolver() = default;
EditSolver::EditSolver(EditSolver&&) noexcept = default;
EditSolver& EditSolver::operator=(EditSolver&&) noexcept = default;

void EditSolver::solve(const EditProblem& problem, const EditParams& params,
                       EditSolution& solution) {
  workspace_->solve(problem, params, solution);
}

EditSolution solve(const EditProblem& problem, const EditParams& params) {
  EditSolution solution;
  EditSolver().solve(problem, params, solution);
  return solution;
}

}  // namespace elte_planner
