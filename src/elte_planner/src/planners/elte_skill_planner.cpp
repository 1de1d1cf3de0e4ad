// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/elte_skill_planner.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "elte_planner/obstacle_avoidance.hpp"

namespace elte_planner {
namespace {

void set_ball(Eigen::Index node, const Eigen::VectorXd& centre, double radius,
              PointConstraint& constraint) {
  constraint.shape = PointConstraint::Shape::kBall;
  constraint.node = node;
  constraint.centre = centre;
  constraint.radius = radius;
}

bool keeps_clear_at(Eigen::Index node, const Eigen::VectorXd& place, const PlanRequest& request) {
  const auto is_clear = [&](const Obstacle& obstacle) {
    return separation(obstacle, place, place).distance >= request.clearance;
  };
  return std::all_of(request.obstacles.begin(), request.obstacles.end(), is_clear) &&
         std::all_of(request.moving.begin(), request.moving.end(),
                     [&](const MovingObstacle& places) {
                       return is_clear(places[static_cast<std::size_t>(node)]);
                     });
}

}  // namespace

ElteSkillPlanner::ElteSkillPlanner(const Eigen::MatrixXd& demonstration, const ElteWeights& weights,
                                   std::string name, const SolveLimits& limits)
    : demonstration_(demonstration),
      weights_(weights),
      name_(std::move(name)),
      limits_(limits),
      solver_(demonstration, weights) {
  if (!(limits.max_step > 0.0)) {
    throw std::invalid_argument("max_step is " + std::to_string(limits.max_step) +
                                " m, must be above 0 m");
  }
  problem_.zeta = demonstration;
  problem_.weights = weights;
  problem_.max_step = limits.max_step;
}

PlanResult ElteSkillPlanner::plan(const PlanRequest& request) {
  validate_request(request, demonstration_);
  if (request.frozen == demonstration_.rows()) return all_frozen(request);
  PlanResult result = plan_without_obstacles(request);
  if (result.status == PlanStatus::kFailed || keeps_clear(result.positions, request)) {
    return result;
  }
  return plan_around_obstacles(request);
}

PlanResult ElteSkillPlanner::plan_without_obstacles(const PlanRequest& request) {
  PlanResult result;
  result.positions = request.previous;
  solver_.solve(request.frozen, request.goal, request.radius, result.positions);
  if (!keeps_step_bound(result, request.frozen) || !keeps_approach(result, request)) {
    return plan_with_constraints(request);
  }
  result.status = PlanStatus::kSolved;
  result.kkt_residual = endpoint_kkt_residual(demonstration_, weights_, result.positions,
                                              request.frozen, request.goal, request.radius);
  return result;
}

bool ElteSkillPlanner::keeps_step_bound(const PlanResult& plan, Eigen::Index frozen) const {
  const Eigen::Index free = demonstration_.rows() - frozen;
  const auto steps = plan.positions.bottomRows(free) - plan.positions.middleRows(frozen - 1, free);
  return steps.rowwise().lpNorm<1>().maxCoeff() <= limits_.max_step;
}

bool ElteSkillPlanner::keeps_approach(const PlanResult& plan, const PlanRequest& request) {
  return std::all_of(request.approach.begin(), request.approach.end(), [&](const NodeBall& ball) {
    return (plan.positions.row(ball.node).transpose() - ball.centre).lpNorm<1>() <= ball.radius;
  });
}

// Returns the radius of the last node's ball.
double ElteSkillPlanner::set_problem(const PlanRequest& request) {
  const Eigen::Index last = demonstration_.rows() - 1;
  problem_.fixed = request.previous.topRows(request.frozen);
  // Just within reach: exactly at its edge every step is at its bound and nothing is left to
  // choose.
  const double reach =
      (1.0 - 1e-6) * limits_.max_step * static_cast<double>(last + 1 - request.frozen);
  const double distance =
      (request.goal.transpose() - request.previous.row(request.frozen - 1)).lpNorm<1>();
  const double radius = std::max(request.radius, distance - reach);
  problem_.constraints.resize(request.approach.size() + 1);
  set_ball(last, request.goal, radius, problem_.constraints[0]);
  for (std::size_t i = 0; i < request.approach.size(); ++i) {
    const NodeBall& ball = request.approach[i];
    set_ball(ball.node, ball.centre, ball.radius, problem_.constraints[i + 1]);
  }
  return radius;
}

PlanResult ElteSkillPlanner::plan_with_constraints(const PlanRequest& request) {
  const double radius = set_problem(request);
  EditParams params;
  params.max_iterations = limits_.max_iterations;
  edit_solver_.solve(problem_, params, solution_);

  PlanResult result;
  result.message = solution_.message;
  if (solution_.status != EditStatus::kSolved) return result;
  return result_from(solution_, radius, request);
}

// A demonstrated line that leads through an obstacle cannot bind the plan there: goals of the
// approach nearer to an obstacle than the clearance are left out.
PlanResult ElteSkillPlanner::plan_around_obstacles(const PlanRequest& request) {
  const double radius = set_problem(request);
  auto& balls = problem_.constraints;  // the first one is the last node's
  balls.erase(std::remove_if(balls.begin() + 1, balls.end(),
                             [&](const PointConstraint& ball) {
                               return !keeps_clear_at(ball.node, ball.centre, request);
                             }),
              balls.end());
  AvoidanceParams params;
  params.max_passes = 50;
  params.max_choices = 16;
  const AvoidanceSolution found = avoid_obstacles(
      {problem_, request.obstacles, request.clearance, request.previous, request.moving}, params);
  PlanResult result;
  result.message = found.message;
  if (found.status == AvoidanceStatus::kNotFound) result.status = PlanStatus::kNoWay;
  if (found.status != AvoidanceStatus::kSolved) return result;
  return result_from(found.plan, radius, request);
}

PlanResult ElteSkillPlanner::result_from(const EditSolution& solution, double radius,
                                         const PlanRequest& request) {
  PlanResult result;
  result.positions = solution.y;
  result.kkt_residual = solution.kkt_residual;
  result.slack = radius - request.radius;
  result.status = result.slack > 0.0 ? PlanStatus::kRelaxed : PlanStatus::kSolved;
  if (result.slack > 0.0) result.message = "the goal is beyond what the bound on steps allows";
  return result;
}

}  // namespace elte_planner
