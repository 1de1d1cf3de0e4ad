// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/obstacle_avoidance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <prf_core/require.hpp>

namespace elte_planner {
namespace {

using Index = Eigen::Index;

AvoidanceStatus without_obstacles(EditStatus status) {
  switch (status) {
    case EditStatus::kSolved:
      return AvoidanceStatus::kSolved;
    case EditStatus::kInfeasible:
      return AvoidanceStatus::kInfeasible;
    case EditStatus::kIllPosed:
      return AvoidanceStatus::kIllPosed;
    case EditStatus::kIterationLimit:
      break;
  }
  return AvoidanceStatus::kIterationLimit;
}

class Avoidance {
 public:
  Avoidance(const AvoidanceProblem& problem, const AvoidanceParams& params)
      : problem_(problem),
        params_(params),
        sides_(problem.obstacles.size() + problem.moving.size()) {
    const Eigen::MatrixXd& zeta = problem.edit.zeta;
    extent_ = std::max(1e-300, (zeta.rowwise() - zeta.row(0)).cwiseAbs().maxCoeff());
    first_ = std::max<Index>(problem.edit.fixed.rows(), 1);
  }

  AvoidanceSolution solve() {
    EditSolver().solve(problem_.edit, {}, best_.plan);
    best_.status = without_obstacles(best_.plan.status);
    best_.message = best_.plan.message;
    if (best_.status != AvoidanceStatus::kSolved) return best_;
    best_.status = AvoidanceStatus::kNotFound;
    const EditSolution unobstructed = best_.plan;
    if (!go_on_from_start()) explore(unobstructed);
    if (best_.status == AvoidanceStatus::kNotFound) {
      best_.message = "no way found around obstacle " + std::to_string(last_hit_) + ", " +
                      std::to_string(choices_) + " choices of sides tried";
    }
    best_.choices = choices_;
    return best_;
  }

 private:
  // During the segment that ends in node k; those in motion count after those at rest.
  const Obstacle& obstacle_at(std::size_t obstacle, Index k) const {
    const std::size_t resting = problem_.obstacles.size();
    return obstacle < resting ? problem_.obstacles[obstacle]
                              : problem_.moving[obstacle - resting][static_cast<std::size_t>(k)];
  }

  Separation separation_of(const Eigen::MatrixXd& y, Index k, std::size_t obstacle) const {
    return separation(obstacle_at(obstacle, k), y.row(k - 1).transpose(), y.row(k).transpose());
  }

  bool is_clear(double distance) const { return distance >= problem_.clearance - 1e-12 * extent_; }

  bool keeps_clearance(const Eigen::MatrixXd& y, std::size_t obstacle) const {
    for (Index k = first_; k < y.rows(); ++k) {
      if (!is_clear(separation_of(y, k, obstacle).distance)) return false;
    }
    return true;
  }

  bool keeps_clearance(const Eigen::MatrixXd& y) const {
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (!keeps_clearance(y, i)) return false;
    }
    return true;
  }

  // The first obstacle without a side that the plan comes too near, else the number of obstacles.
  std::size_t first_hit(const Eigen::MatrixXd& y) const {
    std::size_t i = 0;
    while (i < sides_.size() && (sides_[i].size() > 0 || keeps_clearance(y, i))) ++i;
    return i;
  }

  // Unit vectors across the part of the plan that is too near the obstacle.
  std::vector<Eigen::VectorXd> sides_of(std::size_t obstacle, const Eigen::MatrixXd& y) const {
    Index begin = 0;
    Index end = 0;
    for (Index k = first_; k < y.rows(); ++k) {
      if (is_clear(separation_of(y, k, obstacle).distance)) continue;
      if (end == 0) begin = k - 1;
      end = k;
    }
    const Eigen::VectorXd along = (y.row(end) - y.row(begin)).transpose().normalized();
    std::vector<Eigen::VectorXd> sides;
    for (Index j = 0; j < y.cols(); ++j) {
      Eigen::VectorXd side = Eigen::VectorXd::Unit(y.cols(), j) - along[j] * along;
      if (!(side.norm() > 0.1)) continue;
      side.normalize();
      const auto same = [&](const Eigen::VectorXd& s) { return std::abs(s.dot(side)) > 0.99; };
      if (std::any_of(sides.begin(), sides.end(), same)) continue;
      sides.push_back(side);
      sides.push_back(-side);
    }
    return sides;
  }

  // The sides on which the start passes; false where it meets an obstacle or leads to no plan.
  bool go_on_from_start() {
    if (problem_.start.rows() == 0) return false;
    AvoidanceSolution found;
    if (take_sides_of_start()) {
      EditSolution plan;
      plan.y = problem_.start;
      choices_ = 1;
      descend(plan, found);
    }
    for (Eigen::VectorXd& side : sides_) side.resize(0);
    if (found.status != AvoidanceStatus::kSolved) return false;
    best_ = found;
    return true;
  }

  bool take_sides_of_start() {
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (Index k = first_; k < problem_.start.rows(); ++k) {
        const Separation present = separation_of(problem_.start, k, i);
        if (!(present.distance > 0.0)) return false;
        if (present.distance < nearest) sides_[i] = present.normal;
        nearest = std::min(nearest, present.distance);
      }
    }
    return true;
  }

  // Depth first over the sides of the obstacles that plans run into.
  void explore(const EditSolution& start) {
    if (++choices_ > params_.max_choices) return;
    EditSolution plan = start;
    AvoidanceSolution found;
    const std::size_t hit = descend(plan, found);
    if (hit == sides_.size()) {
      const bool better =
          best_.status == AvoidanceStatus::kNotFound || found.plan.energy < best_.plan.energy;
      if (found.status == AvoidanceStatus::kSolved && better) best_ = found;
      return;
    }
    last_hit_ = hit;
    for (const Eigen::VectorXd& side : sides_of(hit, plan.y)) {
      sides_[hit] = side;
      explore(plan);
    }
    sides_[hit].resize(0);
  }

  // Solves again until the plan rests (`found` is then filled) or runs into an obstacle that has
  // no side yet, which is returned.
  std::size_t descend(EditSolution& plan, AvoidanceSolution& found) {
    bool clear = false;
    for (int pass = 1; pass <= params_.max_passes; ++pass) {
      const std::size_t hit = first_hit(plan.y);
      if (hit < sides_.size()) return hit;
      EditProblem convex = problem_.edit;
      add_planes(plan.y, convex);
      EditSolution next;
      solver_.solve(convex, {}, next);
      if (next.status != EditStatus::kSolved) break;
      clear = keeps_clearance(next.y);
      found.passes = pass;
      found.last_move = (next.y - plan.y).cwiseAbs().maxCoeff();
      plan = next;
      if (clear && found.last_move <= params_.tolerance * extent_) break;
    }
    if (clear) {
      found.status = AvoidanceStatus::kSolved;
      found.plan = plan;
      found.clearance = plan_clearance(plan.y, first_, problem_.obstacles, problem_.moving);
    }
    return sides_.size();
  }

  void add_planes(const Eigen::MatrixXd& y, EditProblem& convex) const {
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      for (Index k = first_; k < y.rows(); ++k) {
        const Obstacle& obstacle = obstacle_at(i, k);
        const Separation present = separation_of(y, k, i);
        const Eigen::VectorXd& away = present.distance > 0.0 ? present.normal : sides_[i];
        const Eigen::VectorXd boundary =
            obstacle.centre + (obstacle.reach(away) + problem_.clearance) * away;
        for (const Index node : {k - 1, k}) {
          if (node < problem_.edit.fixed.rows()) continue;
          convex.constraints.push_back(PointConstraint::half_space(node, boundary, -away));
        }
      }
    }
  }

  const AvoidanceProblem& problem_;
  const AvoidanceParams& params_;
  std::vector<Eigen::VectorXd> sides_;  // where to pass each obstacle; empty: not run into yet
  double extent_ = 1.0;
  Index first_ = 1;
  EditSolver solver_;
  int choices_ = 0;
  std::size_t last_hit_ = 0;
  AvoidanceSolution best_;
};

}  // namespace

void AvoidanceProblem::validate() const {
  edit.validate();
  for (const Obstacle& obstacle : obstacles) obstacle.validate(edit.zeta.cols());
  for (const MovingObstacle& places : moving) {
    prf_core::require(static_cast<Eigen::Index>(places.size()) == edit.zeta.rows(),
                      "places of a moving obstacle", places.size(),
                      std::to_string(edit.zeta.rows()) + ", one for each node");
    for (const Obstacle& place : places) place.validate(edit.zeta.cols());
  }
  prf_core::require(
      start.size() == 0 || (start.rows() == edit.zeta.rows() && start.cols() == edit.zeta.cols() &&
                            is_within_magnitude(start)),
      "start", std::to_string(start.rows()) + " x " + std::to_string(start.cols()),
      "empty or of the demonstration's size, finite");
  prf_core::require(clearance > 0.0 && std::isfinite(clearance), "clearance", clearance,
                    "finite and > 0");
}

AvoidanceSolution avoid_obstacles(const AvoidanceProblem& problem, const AvoidanceParams& params) {
  problem.validate();
  return Avoidance(problem, params).solve();
}

}  // namespace elte_planner
