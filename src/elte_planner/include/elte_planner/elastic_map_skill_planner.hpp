// SPDX-License-Identifier: BSD-3-Clause
//
// Elastic map, to compare ELTE with: it keeps the demonstration's positions instead of its shape,
//
//   minimise |y - zeta|^2 + w_E |E y|^2 + w_R |R y|^2
//
// over the nodes that are not frozen, the last one within the l1 ball around the goal. On the
// approach, zeta is placed where the balls have their centres; it gets there along a ramp.
#pragma once

#include <Eigen/Core>
#include <string>

#include "elte_planner/elte_energy.hpp"
#include "elte_planner/skill_planner.hpp"

namespace elte_planner {

class ElasticMapSkillPlanner : public SkillPlanner {
 public:
  ElasticMapSkillPlanner(const Eigen::MatrixXd& demonstration, const ElteWeights& weights);

  std::string name() const override { return "elastic_map"; }

  [[nodiscard]] PlanResult plan(const PlanRequest& request) override;

 private:
  Eigen::MatrixXd demonstration_;
  ElteWeights weights_;
};

}  // namespace elte_planner
