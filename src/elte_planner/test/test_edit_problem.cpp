// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/edit_problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "allocation_count.hpp"
#include "elte_planner/endpoint_solver.hpp"
#include "quad_reference.hpp"
#include "random_problems.hpp"

namespace elte_planner {
namespace {

using Index = Eigen::Index;

Index random_index(Index low, Index high, std::mt19937& random) {
  return std::uniform_int_distribution<Index>(low, high)(random);
}

double uniform(double low, double high, std::mt19937& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

EditProblem random_problem(std::mt19937& random, Index nodes, Index fixed) {
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

double allowed(const EditProblem& problem, double relative) {
  return relative * (1.0 + problem.weights.elastic + problem.weights.bending) *
         std::max(1.0, problem.zeta.cwiseAbs().maxCoeff());
}

// Stationarity with the reported forces, their membership in the normal cones and feasibility.
void expect_optimal(const EditProblem& problem, const EditSolution& solution, double tolerance) {
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

TEST(EditSolver, SatisfiesTheOptimalityConditionsWhenLittleIsFixed) {
  std::mt19937 random(2);
  int unsettled = 0;  // nothing fixed and hardly any elasticity: rarely found, but then said
  for (int i = 0; i < 1000; ++i) {
    const Index nodes = random_index(5, 100, random);
    EditProblem problem = random_problem(random, nodes, random_index(0, 1, random));
    if (i % 3 == 0) problem.weights.elastic = 0.0;
    const EditSolution solution = solve(problem);
    if (solution.status == EditStatus::kIllPosed) continue;
    if (solution.status == EditStatus::kIterationLimit) {
      ++unsettled;
      ASSERT_EQ(problem.fixed.rows(), 0);
      continue;
    }
    ASSERT_EQ(solution.status, EditStatus::kSolved) << i << ": " << solution.message;
    ASSERT_NO_FATAL_FAILURE(expect_optimal(problem, solution, allowed(problem, 1e-11)))
        << "problem " << i;
  }
  EXPECT_LE(unsettled, 3);
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
    const double plus = solve(problem).energy;
    c.centre -= 2.0 * step * direction;
    const double minus = solve(problem).energy;
    ASSERT_NEAR((plus - minus) / (2.0 * step), -force.dot(direction), 1e-5) << "problem " << i;
  }
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
    if (solution.status == EditStatus::kInfeasible) continue;
    ASSERT_EQ(solution.status, EditStatus::kSolved) << i << " " << solution.message;
    ASSERT_LE(solution.kkt_residual, 1e-11) << i;
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

struct Degenerate : testing::Test {
  Degenerate() {
    std::mt19937 random(9);
    problem.zeta = random_demonstration(30, 3, random);
    problem.fixed = problem.zeta.topRows(5);
    end = problem.zeta.row(29).transpose() + Eigen::Vector3d(0.1, -0.05, 0.2);
  }
  EditProblem problem;
  Eigen::VectorXd end;
};

TEST_F(Degenerate, ConflictingEqualitiesAreNamed) {
  problem.constraints = {PointConstraint::equality(29, end),
                         PointConstraint::equality(29, end.array() + 0.1)};
  const EditSolution solution = solve(problem);
  EXPECT_EQ(solution.status, EditStatus::kInfeasible);
  EXPECT_EQ(solution.y.size(), 0);
  EXPECT_NE(solution.message.find("constraint 1 on node 29"), std::string::npos);
  EXPECT_NE(solution.message.find("constraint 0 on node 29"), std::string::npos);
}

TEST_F(Degenerate, EqualitiesSaidTwiceAreHarmless) {
  problem.constraints = {PointConstraint::equality(29, end), PointConstraint::equality(29, end)};
  const EditSolution twice = solve(problem);
  ASSERT_EQ(twice.status, EditStatus::kSolved) << twice.message;
  problem.constraints.pop_back();
  EXPECT_LE((twice.y - solve(problem).y).cwiseAbs().maxCoeff(), 1e-14);
}

TEST_F(Degenerate, DisjointBallsAreInfeasibleAndTouchingOnesAreNot) {
  const Eigen::Vector3d shift(1.0, 0.0, 0.0);
  problem.constraints = {PointConstraint::ball(20, end, 0.4),
                         PointConstraint::ball(20, end + shift, 0.5)};
  const EditSolution apart = solve(problem);
  EXPECT_EQ(apart.status, EditStatus::kInfeasible);
  EXPECT_NE(apart.message.find("on node 20"), std::string::npos);
  problem.constraints[0].radius = 0.5;
  const EditSolution touching = solve(problem);
  ASSERT_EQ(touching.status, EditStatus::kSolved) << touching.message;
  EXPECT_NEAR((touching.y.row(20).transpose() - end).lpNorm<1>(), 0.5, 1e-12);
}

TEST_F(Degenerate, APointMayCarryAnEqualityInsideABall) {
  problem.constraints = {PointConstraint::ball(29, end.array() + 0.01, 0.2),
                         PointConstraint::equality(29, end)};
  EXPECT_EQ(solve(problem).status, EditStatus::kSolved);
  problem.constraints[0].radius = 0.01;
  EXPECT_EQ(solve(problem).status, EditStatus::kInfeasible);
}

TEST_F(Degenerate, AViolatedFixedRowIsNamed) {
  problem.constraints = {PointConstraint::ball(3, end, 0.001)};
  const EditSolution solution = solve(problem);
  EXPECT_EQ(solution.status, EditStatus::kInfeasible);
  EXPECT_NE(solution.message.find("constraint 0 on node 3"), std::string::npos);
}

TEST_F(Degenerate, TooLittleGivenIsIllPosedWithTheReason) {
  problem.fixed.resize(0, 3);
  EditSolution solution = solve(problem);
  EXPECT_EQ(solution.status, EditStatus::kIllPosed);
  EXPECT_NE(solution.message.find("position"), std::string::npos);
  problem.weights.elastic = 0.0;
  problem.constraints = {PointConstraint::equality(29, end)};
  solution = solve(problem);
  EXPECT_EQ(solution.status, EditStatus::kIllPosed);
  EXPECT_NE(solution.message.find("slope"), std::string::npos);
}

TEST_F(Degenerate, AllRowsFixedOrNoConstraintAtAllAreSolved) {
  EXPECT_EQ(solve(problem).status, EditStatus::kSolved);
  problem.fixed = problem.zeta;
  EXPECT_EQ(solve(problem).y, problem.zeta);
}

TEST_F(Degenerate, ARepeatedPointIsADemonstrationToo) {
  problem.zeta.setConstant(0.3);
  problem.fixed = problem.zeta.topRows(5);
  problem.constraints = {PointConstraint::ball(29, end, 0.02)};
  const EditSolution solution = solve(problem);
  ASSERT_EQ(solution.status, EditStatus::kSolved);
  EXPECT_LE(solution.kkt_residual, 1e-13);
}

TEST_F(Degenerate, AnInfeasibleStepBoundIsNamed) {
  problem.constraints = {PointConstraint::equality(29, end.array() + 5.0)};
  problem.max_step = 0.1;
  const EditSolution solution = solve(problem);
  EXPECT_EQ(solution.status, EditStatus::kInfeasible);
  EXPECT_NE(solution.message.find("step bound"), std::string::npos) << solution.message;
}

TEST_F(Degenerate, InvalidProblemsAreRefused) {
  const auto refused = [this](auto&& change) {
    EditProblem bad = problem;
    bad.constraints = {PointConstraint::ball(29, end, 0.1)};
    change(bad);
    EXPECT_THROW((void)solve(bad), std::invalid_argument);
  };
  refused([](EditProblem& p) { p.constraints[0].node = 30; });
  refused([](EditProblem& p) { p.constraints[0].node = -1; });
  refused([](EditProblem& p) { p.constraints[0].radius = -0.1; });
  refused([](EditProblem& p) { p.constraints[0].radius = std::nan(""); });
  refused([](EditProblem& p) { p.constraints[0].centre[0] = std::nan(""); });
  refused([](EditProblem& p) { p.constraints[0].centre.conservativeResize(2); });
  refused([](EditProblem& p) {
    p.constraints[0] = PointConstraint::half_space(29, p.constraints[0].centre, {});
  });
  refused([](EditProblem& p) {
    const Eigen::Vector3d centre = p.constraints[0].centre;
    p.constraints[0] = PointConstraint::half_space(29, centre, Eigen::Vector3d::Zero());
  });
  refused([](EditProblem& p) { p.fixed = Eigen::MatrixXd::Zero(31, 3); });
  refused([](EditProblem& p) { p.fixed = Eigen::MatrixXd::Zero(2, 2); });
  refused([](EditProblem& p) { p.fixed(0, 0) = std::nan(""); });
  refused([](EditProblem& p) { p.zeta(0, 0) = std::nan(""); });
  refused([](EditProblem& p) { p.max_step = -1.0; });
  refused([](EditProblem& p) { p.max_first_step = std::nan(""); });
}

}  // namespace
}  // namespace elte_planner
