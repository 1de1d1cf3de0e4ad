// SPDX-License-Identifier: BSD-3-Clause
//
// Random problems for EditSolver and the conditions that their solutions must meet.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elte_planner/edit_problem.hpp"
#include "random_problems.hpp"

namespace elte_planner {

using Index = Eigen::Index;

inline Index random_index(Index low, Index high, std::mt19937& random) {
  return std::uniform_int_distribution<Index>(low, high)(random);
}

inline double uniform(double low, double high, std::mt19937& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline EditProblem random_problem(std::mt19937& random, Index nodes, Index fixed) {
  const Index d = random_index(1, 7, random);
  EditProblem problem;
  problem.zeta = random_demonstration(nodes, d, random);
  problem.weights = random_weights(random);
  problem.fixed = problem.zeta.topRows(fixed);
  for (Index k = 0; k < fixed; ++k)
    problem.fixed.row(k) += random_vector(d, 0.01, random).transpose();
  std::vector<Index> places;
  for (Index i = 0, count = random_index(1, 12, random); i < count; ++i) {
    places.push_back(random_index(fixed, nodes - 1, random));
  }
  for (const Index node : places) {
    const bool taken = std::count(places.begin(), places.end(), node) > 1;
    const Eigen::VectorXd centre =
        problem.zeta.row(node).transpose() + random_vector(d, 0.1, random);
    switch (random_index(0, taken ? 0 : 3, random)) {
      case 0:  // several balls on one node all hold the demonstrated point: they meet
        problem.constraints.push_back(PointConstraint::ball(
            node, centre,
            (centre - problem.zeta.row(node).transpose()).lpNorm<1>() * (taken ? 1.2 : 0.3)));
        break;
      case 1:
        problem.constraints.push_back(PointConstraint::equality(node, centre));
        break;
      case 2:
        problem.constraints.push_back(
            PointConstraint::half_space(node, centre, random_vector(d, 1.0, random)));
        break;
      default:
        problem.constraints.push_back(
            PointConstraint::box(node, centre, random_vector(d, 0.05, random).cwiseAbs()));
    }
  }
  return problem;
}

inline double allowed(const EditProblem& problem, double relative) {
  return relative * (1.0 + problem.weights.elastic + problem.weights.bending) *
         std::max(1.0, problem.zeta.cwiseAbs().maxCoeff());
}

// Stationarity with the reported forces, their membership in the normal cones and feasibility.
inline void expect_optimal(const EditProblem& problem, const EditSolution& solution,
                           double tolerance) {
  const Index n = problem.zeta.rows();
  const Index fixed = problem.fixed.rows();
  ASSERT_EQ(solution.y.topRows(fixed), problem.fixed);
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(n, problem.zeta.cols());
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    const PointConstraint& c = problem.constraints[i];
    const Eigen::VectorXd f = solution.forces.row(static_cast<Index>(i)).transpose();
    const Eigen::VectorXd offset = solution.y.row(c.node).transpose() - c.centre;
    force.row(c.node) += f.transpose();
    if (c.shape == PointConstraint::Shape::kBall) {
      ASSERT_LE(offset.lpNorm<1>(), c.radius + tolerance);
      // f . (x - p) <= r |f|_inf for the ball's points, with equality at the solution.
      ASSERT_NEAR(f.dot(offset), c.radius * f.lpNorm<Eigen::Infinity>(), tolerance);
    } else if (c.shape == PointConstraint::Shape::kHalfSpace) {
      const Eigen::VectorXd normal = c.normal.normalized();
      ASSERT_LE(normal.dot(offset), tolerance);
      ASSERT_GE(normal.dot(f), -tolerance);
      ASSERT_LE((f - normal.dot(f) * normal).norm(), tolerance);
      ASSERT_NEAR(f.dot(offset), 0.0, tolerance);
    } else {
      for (Index j = 0; j < f.size(); ++j) {
        ASSERT_LE(std::abs(offset[j]), c.half_widths[j] + tolerance);
        ASSERT_NEAR(f[j] * offset[j], std::abs(f[j]) * c.half_widths[j], tolerance);
      }
    }
  }
  for (Index j = 0; j < problem.zeta.cols(); ++j) {
    for (Index k = fixed; k < n; ++k) {
      const double gradient = 2.0 * half_gradient(problem.zeta, problem.weights, solution.y, k, j);
      ASSERT_NEAR(gradient + force(k, j), 0.0, tolerance) << "node " << k;
    }
  }
  ASSERT_LE(solution.kkt_residual, tolerance);
}

}  // namespace elte_planner
