// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

#include "allocation_count.hpp"
#include "edit_problems.hpp"
#include "elte_planner/endpoint_solver.hpp"

namespace elte_planner {
namespace {

TEST(EditSolver, SatisfiesTheOptimalityConditions) {
  std::mt19937 random(1);
  EditSolver solver;
  EditSolution solution;
  for (int i = 0; i < 3000; ++i) {
    const Index nodes = random_index(5, 120, random);
    const EditProblem problem = random_problem(random, nodes, random_index(2, nodes - 1, random));
    solver.solve(problem, {}, solution);
    ASSERT_EQ(solution.status, EditStatus::kSolved) << i << ": " << solution.message;
    ASSERT_NO_FATAL_FAILURE(expect_optimal(problem, solution, allowed(problem, 1e-12)))
        << "problem " << i;
  }
}

// Nothing determines the slope of a plan that one node holds, without an elastic term or end rows.
bool is_ill_posed(const EditProblem& problem) {
  std::set<Index> held;
  for (Index k = 0; k < problem.fixed.rows(); ++k) held.insert(k);
  for (const PointConstraint& c : problem.constraints) held.insert(c.node);
  return held.size() == 1 && problem.weights.elastic == 0.0 &&
         problem.weights.laplacian == Laplacian::kFreeEnds;
}

TEST(EditSolver, SatisfiesTheOptimalityConditionsWhenLittleIsFixed) {
  std::mt19937 random(2);
  int ill_posed = 0;
  for (int i = 0; i < 1000; ++i) {
    const Index nodes = random_index(5, 100, random);
    EditProblem problem = random_problem(random, nodes, random_index(0, 1, random));
    if (i % 3 == 0) problem.weights.elastic = 0.0;
    const EditSolution solution = solve(problem);
    ASSERT_EQ(solution.status == EditStatus::kIllPosed, is_ill_posed(problem)) << "problem " << i;
    if (solution.status == EditStatus::kIllPosed) {
      ++ill_posed;
      continue;
    }
    ASSERT_EQ(solution.status, EditStatus::kSolved) << i << ": " << solution.message;
    ASSERT_NO_FATAL_FAILURE(expect_optimal(problem, solution, allowed(problem, 1e-11)))
        << "problem " << i;
  }
  EXPECT_GT(ill_posed, 0);
  EXPECT_LT(ill_posed, 50);
}

TEST(EditSolver, AgreesWithTheClosedFormForOneBallAtTheEnd) {
  std::mt19937 random(3);
  for (const Index nodes : {4, 10, 100, 1000, 10000}) {
    for (int i = 0; i < (nodes < 1000 ? 100 : 3); ++i) {
      EditProblem problem;
      problem.zeta = random_demonstration(nodes, 3, random);
      problem.weights.laplacian = i % 2 == 0 ? Laplacian::kFreeEnds : Laplacian::kRowNormalised;
      const Index fixed = random_index(2, nodes - 1, random);
      problem.fixed = problem.zeta.topRows(fixed);
      const Eigen::VectorXd goal =
          problem.zeta.row(nodes - 1).transpose() + random_vector(3, 0.2, random);
      const double radius = i % 3 == 0 ? 0.0 : 0.05;
      problem.constraints = {PointConstraint::ball(nodes - 1, goal, radius)};
      Eigen::MatrixXd expected = problem.zeta;
      EndpointSolver(problem.zeta, problem.weights).solve(fixed, goal, radius, expected);
      const EditSolution solution = solve(problem);
      ASSERT_EQ(solution.status, EditStatus::kSolved) << solution.message;
      ASSERT_LE((solution.y - expected).cwiseAbs().maxCoeff(),
                1e-12 * std::max(1.0, expected.cwiseAbs().maxCoeff()))
          << nodes << " nodes, problem " << i;
    }
  }
}

TEST(EditSolver, ReportsTheSensitivityOfTheEnergyAsForce) {
  std::mt19937 random(4);
  int loaded = 0;
  for (int i = 0; i < 200; ++i) {
    EditProblem problem = random_problem(random, 40, 2);
    problem.weights = ElteWeights{};
    const EditSolution solution = solve(problem);
    ASSERT_EQ(solution.status, EditStatus::kSolved);
    const auto which = static_cast<std::size_t>(
        random_index(0, static_cast<Index>(problem.constraints.size()) - 1, random));
    PointConstraint& c = problem.constraints[which];
    if (c.shape == PointConstraint::Shape::kBox) continue;
    const Eigen::VectorXd force = solution.forces.row(static_cast<Index>(which)).transpose();
    const Eigen::VectorXd direction = random_vector(force.size(), 1.0, random);
    const double step = 1e-6;
    c.centre += step * direction;
    const EditSolution plus = solve(problem);
    c.centre -= 2.0 * step * direction;
    const EditSolution minus = solve(problem);
    ASSERT_EQ(plus.status, EditStatus::kSolved) << plus.message;
    ASSERT_EQ(minus.status, EditStatus::kSolved) << minus.message;
    ASSERT_NEAR((plus.energy - minus.energy) / (2.0 * step), -force.dot(direction), 1e-5)
        << "problem " << i;
    if (force.norm() > 1e-4) ++loaded;
  }
  EXPECT_GT(loaded, 75);
}

TEST(EditSolver, ChangesNothingWhenSolvedAgainOneStepLater) {
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    EditProblem problem = random_problem(random, 60, 5);
    const EditSolution first = solve(problem);
    ASSERT_EQ(first.status, EditStatus::kSolved);
    problem.fixed = first.y.topRows(6);
    const EditSolution again = solve(problem);
    ASSERT_EQ(again.status, EditStatus::kSolved) << again.message;
    ASSERT_LE((again.y - first.y).cwiseAbs().maxCoeff(), 1e-11) << "problem " << i;
  }
}

TEST(EditSolver, KeepsEveryStepWithinItsBound) {
  std::mt19937 random(6);
  int bounded = 0;
  for (int i = 0; i < 500; ++i) {
    const Index nodes = random_index(5, 60, random);
    EditProblem problem;
    problem.zeta = random_demonstration(nodes, random_index(1, 3, random), random);
    problem.weights = ElteWeights{};
    problem.fixed = problem.zeta.topRows(2);
    const Eigen::VectorXd goal = problem.zeta.row(nodes - 1).transpose();
    problem.constraints = {PointConstraint::ball(nodes - 1, goal, 0.1)};
    const double longest = (problem.zeta.bottomRows(nodes - 1) - problem.zeta.topRows(nodes - 1))
                               .rowwise()
                               .lpNorm<1>()
                               .maxCoeff();
    problem.max_step = longest * uniform(0.6, 1.0, random);
    problem.max_first_step = problem.max_step * uniform(0.3, 1.0, random);
    const EditSolution solution = solve(problem);
    ASSERT_EQ(solution.status, EditStatus::kSolved) << i << " " << solution.message;
    ASSERT_LE(solution.kkt_residual, 1e-11) << i;
    for (Index k = 2; k < nodes; ++k) {
      const double step = (solution.y.row(k) - solution.y.row(k - 1)).lpNorm<1>();
      ASSERT_LE(step, (k == 2 ? problem.max_first_step : problem.max_step) + 1e-12) << i;
    }
    if (solution.active_facets > 1) ++bounded;
  }
  EXPECT_GT(bounded, 100);
}

TEST(EditSolver, HandlesManyObstacleBalls) {
  std::mt19937 random(7);
  for (int i = 0; i < 30; ++i) {
    EditProblem problem;
    problem.zeta = random_demonstration(100, 3, random);
    problem.weights.elastic = 1.0;
    problem.fixed = problem.zeta.topRows(2);
    for (Index k = 2; k < 100; ++k) {
      const Eigen::VectorXd centre =
          problem.zeta.row(k).transpose() + random_vector(3, 0.05, random);
      problem.constraints.push_back(PointConstraint::ball(k, centre, 0.05));
    }
    const EditSolution solution = solve(problem);
    ASSERT_EQ(solution.status, EditStatus::kSolved) << solution.message;
    EXPECT_GT(solution.active_facets, 50);
    ASSERT_NO_FATAL_FAILURE(expect_optimal(problem, solution, 1e-11)) << "problem " << i;
  }
}

TEST(EditSolver, KeepsItsDigitsFarFromTheOrigin) {
  std::mt19937 random(8);
  EditProblem problem = random_problem(random, 80, 3);
  problem.weights = ElteWeights{};
  const EditSolution near = solve(problem);
  ASSERT_EQ(near.status, EditStatus::kSolved) << near.message;
  problem.zeta.array() += 1048576.0;
  problem.fixed.array() += 1048576.0;
  for (PointConstraint& c : problem.constraints) c.centre.array() += 1048576.0;
  const EditSolution far = solve(problem);
  ASSERT_EQ(far.status, EditStatus::kSolved) << far.message;
  EXPECT_LE(((far.y.array() - 1048576.0).matrix() - near.y).cwiseAbs().maxCoeff(), 1e-7);
}

#ifdef ELTE_PLANNER_COUNTS_ALLOCATIONS
TEST(EditSolver, DoesNotAllocateWhenSolvingAgain) {
  std::mt19937 random(10);
  int constrained = 0;
  for (int i = 0; i < 200; ++i) {
    EditProblem problem = random_problem(random, 60, 5);
    problem.max_step = 10.0;
    EditSolver solver;
    EditSolution solution;
    solver.solve(problem, {}, solution);
    ASSERT_EQ(solution.status, EditStatus::kSolved) << solution.message;
    const long before = g_allocations;
    solver.solve(problem, {}, solution);
    const long during = g_allocations - before;
    ASSERT_EQ(during, 0) << "problem " << i;
    if (solution.active_facets > 1) ++constrained;
  }
  EXPECT_GT(constrained, 100);
}
#endif

}  // namespace
}  // namespace elte_planner
