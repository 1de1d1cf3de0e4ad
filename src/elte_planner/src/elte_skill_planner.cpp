// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/elte_skill_planner.hpp"

#include <utility>

namespace elte_planner {

ElteSkillPlanner::ElteSkillPlanner(const Eigen::MatrixXd& demonstration, const ElteWeights& weights,
                                   std::string name)
    : demonstration_(demonstration),
      weights_(weights),
      name_(std::move(name)),
      solver_(demonstration, weights) {}

PlanResult ElteSkillPlanner::plan(const PlanRequest& request) const {
  validate_request(request, demonstration_);
  if (request.frozen == demonstration_.rows()) return all_frozen(request);
  PlanResult result;
  result.positions = request.previous;
  solver_.solve(request.frozen, request.goal, request.radius, result.positions);
  result.status = PlanStatus::kSolved;
  result.kkt_residual = endpoint_kkt_residual(demonstration_, weights_, result.positions,
                                              request.frozen, request.goal, request.radius);
  return result;
}

}  // namespace elte_planner
