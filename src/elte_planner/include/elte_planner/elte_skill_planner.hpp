// SPDX-License-Identifier: BSD-3-Clause
//
// Elastic Laplacian trajectory editing behind the planners' common interface. Without elastic and
// bending terms and with the row-normalised Laplacian it is Laplacian trajectory editing (LTE,
// Nierhoff, Hirche, Nakamura 2016).
#pragma once

#include <Eigen/Core>
#include <string>

#include "elte_planner/elte_energy.hpp"
#include "elte_planner/endpoint_solver.hpp"
#include "elte_planner/skill_planner.hpp"

namespace elte_planner {

class ElteSkillPlanner : public SkillPlanner {
 public:
  ElteSkillPlanner(const Eigen::MatrixXd& demonstration, const ElteWeights& weights,
                   std::string name = "elte");

  std::string name() const override { return name_; }

  [[nodiscard]] PlanResult plan(const PlanRequest& request) const override;

 private:
  Eigen::MatrixXd demonstration_;
  ElteWeights weights_;
  std::string name_;
  EndpointSolver solver_;
};

}  // namespace elte_planner
