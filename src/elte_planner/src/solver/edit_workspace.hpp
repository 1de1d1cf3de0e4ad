// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "active_set.hpp"
#include "elte_planner/edit_problem.hpp"
#include "step_chain.hpp"

namespace elte_planner {

// Positions are held relative to the first fixed row or, when there is none, to zeta's: an offset
// of the whole problem then costs no digits.
class EditSolver::Workspace {
 public:
  void solve(const EditProblem& problem, const EditParams& params, EditSolution& solution);

 private:
  enum class SolveResult { kDone, kInfeasible, kIterationLimit };

  void prepare();
  std::string ill_posed_reason() const;
  bool fixed_rows_are_feasible(EditSolution& solution) const;
  void build_right_side();
  void solve_from_here(EditSolution& solution);

  SolveResult solve_strictly_convex(EditSolution& solution);
  bool move_proximal_centre();
  void set_centre(const Eigen::VectorXd& centre);
  void respond_to_centre(Eigen::Index j, bool slope, Eigen::MatrixXd& change);
  bool add_equalities(EditSolution& solution, SolveResult& result);
  SolveResult add_violated(int patience, EditSolution& solution);
  SolveResult enter(double violation, EditSolution& solution);
  bool most_violated(Facet& facet, double& violation);
  void offer_ball(int constraint, Eigen::Index index, bool on_step, double radius, double& worst,
                  Facet& best);
  void offer_box(int constraint, double& worst, Facet& best);
  void offer_half_space(int constraint, double& worst, Facet& best);

  void recompute_from_multipliers();
  void polish();
  double violation_of(const Facet& facet, Eigen::Index normal) const;

  std::string name_of(int constraint) const;
  void name_contradiction(EditSolution& solution) const;
  void report(EditSolution& solution);
  void refine(EditSolution& solution);
  double residual(const EditSolution& solution);
  void newton_step();
  void compute_gradient(const Eigen::MatrixXd& y);

  const EditProblem* problem_ = nullptr;
  const EditParams* params_ = nullptr;
  Eigen::Index n_ = 0;
  Eigen::Index d_ = 0;
  Eigen::Index fixed_rows_ = 0;
  int iteration_limit_ = 0;
  double extent_ = 1.0;
  double tolerance_ = 0.0;  // of feasibility, in the unit of the problem
  double last_centre_step_ = std::numeric_limits<double>::infinity();
  StepChain chain_;
  ActiveSet active_;
  Eigen::VectorXd last_centre_;
  Eigen::VectorXd last_residual_;
  Eigen::VectorXd centre_step_;
  Eigen::RowVectorXd origin_;
  Eigen::RowVectorXd start_;  // y_0 of the proximal term
  Eigen::RowVectorXd slope_;  // v_1 of the proximal term
  Eigen::MatrixXd centres_;   // constraints x dimensions, relative
  Eigen::MatrixXd right_;     // of the equations in the steps
  Eigen::MatrixXd y_;         // relative
  Eigen::MatrixXd absolute_;
  Eigen::MatrixXd steps_;
  Eigen::VectorXd displacement_;
  Eigen::MatrixXd gradient_;  // half that of the Lagrangian
  Eigen::VectorXd best_normal_;
  Eigen::VectorXd trial_normal_;
  Eigen::VectorXd values_;
  // What stood before a step of refinement.
  EditSolution solution_before_;
  Eigen::MatrixXd y_before_;
  std::vector<Facet> facets_before_;
};

// Largest excess over the constraint's bound, negative inside.
double violation_of(const PointConstraint& c, const Eigen::MatrixXd& y);

inline bool is_equality(const PointConstraint& c) {
  return c.shape == PointConstraint::Shape::kBall && c.radius == 0.0;
}

}  // namespace elte_planner
