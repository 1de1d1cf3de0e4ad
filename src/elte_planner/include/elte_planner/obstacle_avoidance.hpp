// SPDX-License-Identifier: BSD-3-Clause
//
// ELTE whose polyline, not only its nodes, keeps a clearance from obstacles:
//
//   minimise J(y) under the constraints of edit_problem.hpp, subject to
//     distance(segment y_{k-1} y_k, obstacle) >= clearance   for every segment that is not fixed
//
// Both ends of a segment beyond a plane that the obstacle touches, `clearance` away from it, is
// enough for the whole segment. The planes are taken from the present plan's nearest points and the
// convex problem is solved again until the plan changes no more: from a plan that keeps the
// clearance the next one does, too, at no more energy. Where a plan runs into an obstacle, the
// sides on which it could pass are tried in turn, and the plan of least energy among those tried is
// returned. It is a local minimum.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elte_planner/edit_problem.hpp"
#include "elte_planner/obstacle.hpp"

namespace elte_planner {

struct AvoidanceProblem {
  EditProblem edit;
  std::vector<Obstacle> obstacles;
  double clearance = 0.0;  // in the unit of the demonstration, > 0
  // Optional, nodes x dimensions: a plan that meets no obstacle, such as the one before. The way
  // beside it is taken when there is one, whatever the energy of others: a plan does not change
  // sides without need.
  Eigen::MatrixXd start = {};
  std::vector<MovingObstacle> moving = {};  // beside `obstacles`; each has a place for every node

  void validate() const;  // throws std::invalid_argument
};

struct AvoidanceParams {
  int max_passes = 200;     // convex problems per choice of sides
  int max_choices = 64;     // of sides
  double tolerance = 1e-9;  // change of a plan that counts as none, relative to the demonstration's
                            // largest coordinate from its first node
};

enum class AvoidanceStatus {
  kSolved,
  kNotFound,        // no way on any side that was tried; that is no proof that there is none
  kInfeasible,      // the problem without the obstacles is proved infeasible
  kIllPosed,        // the problem without the obstacles is ill-posed
  kIterationLimit,  // numerical failure
};

struct AvoidanceSolution {
  AvoidanceStatus status = AvoidanceStatus::kIllPosed;
  std::string message;     // one line when not solved
  EditSolution plan;       // of the last convex problem
  double clearance = 0.0;  // of the polyline from the last fixed row on
  double last_move = 0.0;  // largest coordinate change of the last pass
  int passes = 0;          // of the choice taken
  int choices = 0;         // tried
};

// Throws std::invalid_argument for an invalid problem.
[[nodiscard]] AvoidanceSolution avoid_obstacles(const AvoidanceProblem& problem,
                                                const AvoidanceParams& params = {});

}  // namespace elte_planner
