// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/skill_planner.hpp"

#include <algorithm>
#include <cmath>
#include <prf_core/require.hpp>
#include <stdexcept>

#include "elte_planner/dmp_skill_planner.hpp"
#include "elte_planner/elastic_map_skill_planner.hpp"
#include "elte_planner/elte_skill_planner.hpp"

namespace elte_planner {
namespace {

using Maker = std::unique_ptr<SkillPlanner> (*)(const Eigen::MatrixXd& demonstration,
                                                const ElteWeights& weights,
                                                const SolveLimits& limits);

void require_no_step_bound(const char* planner, const SolveLimits& limits) {
  prf_core::require(std::isinf(limits.max_step), "max_step", limits.max_step,
                    std::string("without bound: planner ") + planner + " keeps none");
}

struct Factory {
  const char* name;
  Maker make;
};

constexpr Factory kFactories[] = {
    {"elte",
     [](const Eigen::MatrixXd& zeta, const ElteWeights& weights,
        const SolveLimits& limits) -> std::unique_ptr<SkillPlanner> {
       return std::make_unique<ElteSkillPlanner>(zeta, weights, "elte", limits);
     }},
    {"lte",
     [](const Eigen::MatrixXd& zeta, const ElteWeights&,
        const SolveLimits& limits) -> std::unique_ptr<SkillPlanner> {
       const ElteWeights shape_only{0.0, 0.0, Laplacian::kRowNormalised};
       return std::make_unique<ElteSkillPlanner>(zeta, shape_only, "lte", limits);
     }},
    {"elastic_map",
     [](const Eigen::MatrixXd& zeta, const ElteWeights& weights,
        const SolveLimits& limits) -> std::unique_ptr<SkillPlanner> {
       require_no_step_bound("elastic_map", limits);
       return std::make_unique<ElasticMapSkillPlanner>(zeta, weights);
     }},
    {"dmp",
     [](const Eigen::MatrixXd& zeta, const ElteWeights&,
        const SolveLimits& limits) -> std::unique_ptr<SkillPlanner> {
       require_no_step_bound("dmp", limits);
       return std::make_unique<DmpSkillPlanner>(zeta);
     }},
};

}  // namespace

void validate_request(const PlanRequest& request, const Eigen::MatrixXd& demonstration) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument(what); };
  const Eigen::Index nodes = demonstration.rows();
  if (request.previous.rows() != nodes || request.previous.cols() != demonstration.cols() ||
      request.goal.size() != demonstration.cols()) {
    refuse("previous plan is " + std::to_string(request.previous.rows()) + " x " +
           std::to_string(request.previous.cols()) + " and goal has " +
           std::to_string(request.goal.size()) + " coordinates, must be " + std::to_string(nodes) +
           " x " + std::to_string(demonstration.cols()));
  }
  if (request.frozen < 2 || request.frozen > nodes) {
    refuse("frozen is " + std::to_string(request.frozen) + ", must be within [2, " +
           std::to_string(nodes) + "]");
  }
  if (!std::isfinite(request.radius) || request.radius < 0.0) {
    refuse("radius is " + std::to_string(request.radius) + ", must be finite and at least 0");
  }
  if (!is_within_magnitude(request.goal)) {
    refuse("goal has a coordinate that is not finite or above 1e100");
  };
  for (const NodeBall& ball : request.approach) {
    if (ball.node < request.frozen || ball.node >= nodes ||
        ball.centre.size() != request.goal.size() || !is_within_magnitude(ball.centre) ||
        !std::isfinite(ball.radius) || ball.radius < 0.0) {
      refuse("ball of the approach at node " + std::to_string(ball.node) +
             " is not finite or not at a free node");
    }
  }
  if (!is_within_magnitude(request.previous.topRows(request.frozen))) {
    refuse("frozen rows of the previous plan have a coordinate that is not finite or above 1e100");
  }
}

void refuse_obstacles(const PlanRequest& request, const std::string& planner) {
  const std::size_t count = request.obstacles.size() + request.moving.size();
  prf_core::require(count == 0, "obstacles", count,
                    "0: planner " + planner + " keeps no clearance");
}

bool keeps_clear(const Eigen::MatrixXd& positions, const PlanRequest& request) {
  if (request.obstacles.empty() && request.moving.empty()) return true;
  return plan_clearance(positions, request.frozen, request.obstacles, request.moving) >=
         request.clearance;
}

PlanResult all_frozen(const PlanRequest& request) {
  PlanResult result;
  result.positions = request.previous;
  const Eigen::VectorXd end = request.previous.row(request.previous.rows() - 1).transpose();
  result.slack = std::max((request.goal - end).lpNorm<1>() - request.radius, 0.0);
  result.status = result.slack > 0.0 ? PlanStatus::kRelaxed : PlanStatus::kSolved;
  if (result.slack > 0.0) result.message = "every node is frozen, the end cannot move to the goal";
  return result;
}

std::vector<std::string> planner_names() {
  std::vector<std::string> names;
  for (const Factory& factory : kFactories) names.emplace_back(factory.name);
  return names;
}

std::unique_ptr<SkillPlanner> make_skill_planner(const std::string& name,
                                                 const Eigen::MatrixXd& demonstration,
                                                 const ElteWeights& weights,
                                                 const SolveLimits& limits) {
  std::string known;
  for (const Factory& factory : kFactories) {
    if (name == factory.name) return factory.make(demonstration, weights, limits);
    known += (known.empty() ? "" : ", ") + std::string(factory.name);
  }
  prf_core::require(false, "planner", name, "one of: " + known);
  return nullptr;
}

}  // namespace elte_planner
