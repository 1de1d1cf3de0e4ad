// SPDX-License-Identifier: BSD-3-Clause
//
// What every planner of a skill offers: from a demonstration given at construction (nodes x
// dimensions, m), bend the part of the plan that is not yet executed so that its end comes within
// an l1 ball of the goal.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "elte_planner/elte_energy.hpp"
#include "elte_planner/obstacle.hpp"

namespace elte_planner {

enum class PlanStatus {
  kSolved,
  kRelaxed,  // infeasible as asked; the radius was enlarged by `slack`
  kFailed,   // no plan, the message says why
  kNoWay,    // no plan, because none was found that keeps clear of the obstacles
};

struct NodeBall {
  Eigen::Index node = 0;
  Eigen::VectorXd centre;
  double radius = 0.0;  // l1, >= 0
};

struct PlanRequest {
  Eigen::MatrixXd previous;  // nodes x dimensions; its first `frozen` rows are kept as they are
  Eigen::Index frozen = 2;   // 2 .. nodes
  Eigen::VectorXd goal;
  double radius = 0.0;  // of the l1 ball around the goal, >= 0
  // Of free nodes before the last. elte and lte keep them; elastic_map and dmp plan in a frame that
  // moves with their centres.
  std::vector<NodeBall> approach = {};
  // Every segment that is not frozen keeps `clearance` from these, else kNoWay. elte and lte look
  // for a way and leave out balls of the approach that are nearer themselves; dmp is pushed off and
  // may find none; elastic_map refuses obstacles.
  std::vector<Obstacle> obstacles = {};
  std::vector<MovingObstacle> moving = {};  // likewise; each has a place for every node
  double clearance = 0.0;                   // m, > 0 with obstacles
};

struct PlanResult {
  PlanStatus status = PlanStatus::kFailed;
  Eigen::MatrixXd positions;  // nodes x dimensions; empty when failed
  double kkt_residual = 0.0;  // in the unit of the positions; 0 for planners without one
  double slack = 0.0;         // added to the radius when relaxed
  std::string message;        // one line when not solved
};

class SkillPlanner {
 public:
  SkillPlanner() = default;
  SkillPlanner(const SkillPlanner&) = delete;
  SkillPlanner& operator=(const SkillPlanner&) = delete;
  virtual ~SkillPlanner() = default;

  virtual std::string name() const = 0;

  // Depends on the request alone; memory is kept for the next one. Throws std::invalid_argument for
  // a request of wrong size or with values that are not finite.
  [[nodiscard]] virtual PlanResult plan(const PlanRequest& request) = 0;
};

// For implementations: throws std::invalid_argument unless the request fits the demonstration.
// Obstacles and clearance are left to those that know them.
void validate_request(const PlanRequest& request, const Eigen::MatrixXd& demonstration);

// For implementations that keep no clearance: throws std::invalid_argument for any obstacle.
void refuse_obstacles(const PlanRequest& request, const std::string& planner);

// For implementations: whether a plan keeps the clearance.
[[nodiscard]] bool keeps_clear(const Eigen::MatrixXd& positions, const PlanRequest& request);

// For implementations: the result when every node is frozen. Solved when the last node is within
// the ball, else relaxed by what is missing.
[[nodiscard]] PlanResult all_frozen(const PlanRequest& request);

// The names that make_skill_planner() knows.
[[nodiscard]] std::vector<std::string> planner_names();

// Only elte and lte know them.
struct SolveLimits {
  // m, greatest l1 distance of consecutive nodes that are not frozen, above 0; others refuse one
  double max_step = std::numeric_limits<double>::infinity();
  // Bounds the work of one plan, and unlike a clock gives the same answer on every machine; beyond
  // it the plan has failed.
  int max_iterations = 2000;
};

// Throws std::invalid_argument, listing the known names when `name` is none of them.
[[nodiscard]] std::unique_ptr<SkillPlanner> make_skill_planner(const std::string& name,
                                                               const Eigen::MatrixXd& demonstration,
                                                               const ElteWeights& weights,
                                                               const SolveLimits& limits = {});

}  // namespace elte_planner
