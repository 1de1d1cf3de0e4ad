// SPDX-License-Identifier: BSD-3-Clause
//
// Elastic Laplacian trajectory editing behind the planners' common interface.
#pragma once

#include <Eigen/Core>
#include <string>

#include "elte_planner/elte_energy.hpp"
#include "elte_planner/endpoint_solver.hpp"
#include "elte_planner/skill_planner.hpp"

namespace elte_planner {

class ElteSkillPlanner : public SkillPlanner {
 public:
  ElteSkillPlanner(const Eigen::MatrixXd& demonstration, const ElteWeights& weights);

  std::string name() const override { return "elte"; }

  [[nodiscard]] PlanResult plan(const PlanRequest& request) const override;

 private:
  Eigen::MatrixXd demonstration_;
  ElteWeights weights_;
  EndpointSolver solver_;
};

}  // namespace elte_planner
