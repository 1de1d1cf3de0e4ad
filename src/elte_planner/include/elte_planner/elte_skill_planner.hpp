// SPDX-License-Identifier: BSD-3-Clause
//
// Elastic Laplacian trajectory editing behind the planners' common interface. Without elastic and
// bending terms and with the row-normalised Laplacian it is Laplacian trajectory editing (LTE,
// Nierhoff, Hirche, Nakamura 2016).
//
// With a bound s on the steps and m free nodes, the last node can lie no farther (l1) than m s from
// the last frozen node. When the goal's ball is farther away, its radius is enlarged by what is
// missing.
#pragma once

#include <Eigen/Core>
#include <string>

#include "elte_planner/edit_problem.hpp"
#include "elte_planner/elte_energy.hpp"
#include "elte_planner/endpoint_solver.hpp"
#include "elte_planner/skill_planner.hpp"

namespace elte_planner {

class ElteSkillPlanner : public SkillPlanner {
 public:
  ElteSkillPlanner(const Eigen::MatrixXd& demonstration, const ElteWeights& weights,
                   std::string name, const SolveLimits& limits);

  std::string name() const override { return name_; }

  [[nodiscard]] PlanResult plan(const PlanRequest& request) override;

 private:
  bool keeps_step_bound(const PlanResult& plan, Eigen::Index frozen) const;
  static bool keeps_approach(const PlanResult& plan, const PlanRequest& request);
  PlanResult plan_without_obstacles(const PlanRequest& request);
  PlanResult plan_with_constraints(const PlanRequest& request);
  PlanResult plan_around_obstacles(const PlanRequest& request);
  double set_problem(const PlanRequest& request);
  static PlanResult result_from(const EditSolution& solution, double radius,
                                const PlanRequest& request);

  Eigen::MatrixXd demonstration_;
  ElteWeights weights_;
  std::string name_;
  SolveLimits limits_;
  EndpointSolver solver_;  // where the balls before the last node do not matter
  EditSolver edit_solver_;
  EditProblem problem_;
  EditSolution solution_;
};

}  // namespace elte_planner
