// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/endpoint_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "allocation_count.hpp"
#include "quad_reference.hpp"
#include "random_problems.hpp"

namespace elte_planner {
namespace {

struct Case {
  Eigen::MatrixXd zeta;
  ElteWeights weights;
  Eigen::Index frozen;
  Eigen::VectorXd goal;
  double radius;
  Eigen::MatrixXd plan;  // before solving
};

Case random_case(Eigen::Index nodes, std::mt19937& random) {
  const Eigen::Index dimensions = std::uniform_int_distribution<Eigen::Index>(1, 7)(random);
  Case c;
  c.zeta = random_demonstration(nodes, dimensions, random);
  c.weights = random_weights(random);
  c.frozen = std::uniform_int_distribution<Eigen::Index>(2, nodes - 1)(random);
  c.goal = c.zeta.row(nodes - 1).transpose() + random_vector(dimensions, 0.2, random);
  c.radius = std::bernoulli_distribution(0.5)(random)
                 ? 0.0
                 : std::uniform_real_distribution<double>(0.0, 0.3)(random);
  c.plan = c.zeta;
  for (Eigen::Index k = 0; k < c.frozen; ++k) {
    c.plan.row(k) += random_vector(dimensions, 0.002, random).transpose();
  }
  return c;
}

double scale(const Case& c) { return std::max(1.0, c.plan.cwiseAbs().maxCoeff()); }

TEST(EndpointSolver, SatisfiesTheOptimalityConditionsOfTheOriginalProblem) {
  std::mt19937 random(1);
  for (int i = 0; i < 5000; ++i) {
    Case c = random_case(std::uniform_int_distribution<Eigen::Index>(3, 120)(random), random);
    const EndpointSolver solver(c.zeta, c.weights);
    Eigen::MatrixXd plan = c.plan;
    solver.solve(c.frozen, c.goal, c.radius, plan);
    ASSERT_LE(endpoint_kkt_residual(c.zeta, c.weights, plan, c.frozen, c.goal, c.radius),
              1e-13 * scale(c) * (1.0 + c.weights.elastic + c.weights.bending))
        << "problem " << i;
    ASSERT_LE((plan.row(plan.rows() - 1).transpose() - c.goal).lpNorm<1>(), c.radius + 1e-15);
  }
}

TEST(EndpointSolver, LeavesTheFrozenRowsUntouched) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    Case c = random_case(std::uniform_int_distribution<Eigen::Index>(3, 80)(random), random);
    Eigen::MatrixXd plan = c.plan;
    EndpointSolver(c.zeta, c.weights).solve(c.frozen, c.goal, c.radius, plan);
    ASSERT_EQ(plan.topRows(c.frozen), c.plan.topRows(c.frozen)) << "problem " << i;
  }
}

TEST(EndpointSolver, MeetsAnEqualityAtTheEndExactly) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    Case c = random_case(std::uniform_int_distribution<Eigen::Index>(3, 200)(random), random);
    Eigen::MatrixXd plan = c.plan;
    EndpointSolver(c.zeta, c.weights).solve(c.frozen, c.goal, 0.0, plan);
    ASSERT_EQ(plan.row(plan.rows() - 1).transpose(), c.goal) << "problem " << i;
  }
}

TEST(EndpointSolver, ChangesNothingWhenSolvedAgainOneStepLater) {
  std::mt19937 random(4);
  for (int i = 0; i < 1000; ++i) {
    Case c = random_case(std::uniform_int_distribution<Eigen::Index>(5, 150)(random), random);
    const EndpointSolver solver(c.zeta, c.weights);
    Eigen::MatrixXd plan = c.plan;
    solver.solve(c.frozen, c.goal, c.radius, plan);
    for (Eigen::Index frozen = c.frozen + 1; frozen < plan.rows(); ++frozen) {
      Eigen::MatrixXd again = plan;
      solver.solve(frozen, c.goal, c.radius, again);
      ASSERT_LE((again - plan).cwiseAbs().maxCoeff(), 1e-13 * scale(c))
          << "problem " << i << ", frozen " << frozen;
    }
  }
}

TEST(EndpointSolver, TreatsDimensionsIndependentlyForAnEquality) {
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    Case c = random_case(std::uniform_int_distribution<Eigen::Index>(3, 80)(random), random);
    Eigen::MatrixXd plan = c.plan;
    EndpointSolver(c.zeta, c.weights).solve(c.frozen, c.goal, 0.0, plan);
    for (Eigen::Index j = 0; j < plan.cols(); ++j) {
      Eigen::MatrixXd alone = c.plan.col(j);
      EndpointSolver(c.zeta.col(j), c.weights).solve(c.frozen, c.goal.segment(j, 1), 0.0, alone);
      ASSERT_EQ(alone.col(0), plan.col(j)) << "problem " << i;
    }
  }
}

TEST(EndpointSolver, AgreesWithAnIndependentSolutionAtEveryLength) {
  std::mt19937 random(6);
  double worst = 0.0;
  for (const Eigen::Index nodes : {3, 4, 5, 10, 17, 18, 33, 50, 100, 1000, 10000}) {
    for (int i = 0; i < (nodes < 1000 ? 30 : 4); ++i) {
      Case c = random_case(nodes, random);
      if (i % 2 == 0) c.frozen = 2;
      Eigen::MatrixXd plan = c.plan;
      EndpointSolver(c.zeta, c.weights).solve(c.frozen, c.goal, c.radius, plan);
      const QuadReference reference(c.zeta, c.weights);
      const Eigen::MatrixXd expected = reference.solve(c.frozen, nodes - 1, plan);
      const double error = (plan - expected).cwiseAbs().maxCoeff() / scale(c);
      worst = std::max(worst, error);
      ASSERT_LE(error, 1e-12) << nodes << " nodes, frozen " << c.frozen;
    }
  }
  RecordProperty("largest_relative_error", std::to_string(worst));
}

TEST(EndpointSolver, TakesTheFreeOptimumWhenTheBallHoldsIt) {
  std::mt19937 random(7);
  for (const Eigen::Index nodes : {3, 20, 100}) {
    for (int i = 0; i < 50; ++i) {
      Case c = random_case(nodes, random);
      Eigen::MatrixXd plan = c.plan;
      EndpointSolver(c.zeta, c.weights).solve(c.frozen, c.goal, 1e9, plan);
      const Eigen::MatrixXd expected =
          QuadReference(c.zeta, c.weights).solve(c.frozen, nodes, c.plan);
      ASSERT_LE((plan - expected).cwiseAbs().maxCoeff(), 1e-12 * scale(c)) << nodes;
    }
  }
}

TEST(EndpointSolver, KeepsItsAccuracyFarFromTheOrigin) {
  std::mt19937 random(8);
  for (int i = 0; i < 50; ++i) {
    Case c = random_case(200, random);
    const double offset = 1e6;
    Eigen::MatrixXd near = c.plan;
    EndpointSolver(c.zeta, c.weights).solve(c.frozen, c.goal, c.radius, near);
    Eigen::MatrixXd far = c.plan.array() + offset;
    EndpointSolver(c.zeta.array() + offset, c.weights)
        .solve(c.frozen, c.goal.array() + offset, c.radius, far);
    // Rounding the inputs at 1e6 moves them by 1e-10; that is all that may be lost.
    ASSERT_LE(((far.array() - offset).matrix() - near).cwiseAbs().maxCoeff(), 1e-6);
    ASSERT_LE(endpoint_kkt_residual(c.zeta.array() + offset, c.weights, far, c.frozen,
                                    c.goal.array() + offset, c.radius),
              1e-15 * 8.0 * offset * (1.0 + c.weights.bending + c.weights.elastic));
  }
}

#ifdef ELTE_PLANNER_COUNTS_ALLOCATIONS
TEST(EndpointSolver, DoesNotAllocateWhenSolvingAgain) {
  std::mt19937 random(9);
  Case c = random_case(100, random);
  const EndpointSolver solver(c.zeta, c.weights);
  solver.solve(c.frozen, c.goal, 0.02, c.plan);
  const long before = g_allocations;
  solver.solve(c.frozen, c.goal, 0.02, c.plan);
  const long during = g_allocations - before;
  EXPECT_EQ(during, 0);
}
#endif

TEST(EndpointSolver, RefusesWhatIsNoProblem) {
  std::mt19937 random(10);
  const Eigen::MatrixXd zeta = random_demonstration(10, 2, random);
  EXPECT_THROW(EndpointSolver(zeta.topRows(2), {}), std::invalid_argument);
  EXPECT_THROW(EndpointSolver(Eigen::MatrixXd(10, 0), {}), std::invalid_argument);
  EXPECT_THROW(EndpointSolver(zeta, {-1.0, 0.0, Laplacian::kFreeEnds}), std::invalid_argument);
  EXPECT_THROW(EndpointSolver(zeta, {0.0, std::nan(""), Laplacian::kFreeEnds}),
               std::invalid_argument);
  Eigen::MatrixXd broken = zeta;
  broken(3, 1) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(EndpointSolver(broken, {}), std::invalid_argument);

  const EndpointSolver solver(zeta, {});
  Eigen::MatrixXd plan = zeta;
  const Eigen::Vector2d goal(0.0, 0.0);
  EXPECT_NO_THROW(solver.solve(2, goal, 0.0, plan));
  EXPECT_THROW(solver.solve(1, goal, 0.0, plan), std::invalid_argument);
  EXPECT_THROW(solver.solve(10, goal, 0.0, plan), std::invalid_argument);
  EXPECT_THROW(solver.solve(2, goal, -1e-9, plan), std::invalid_argument);
  EXPECT_THROW(solver.solve(2, goal, std::nan(""), plan), std::invalid_argument);
  EXPECT_THROW(solver.solve(2, Eigen::Vector3d::Zero(), 0.0, plan), std::invalid_argument);
  EXPECT_THROW(solver.solve(2, Eigen::Vector2d(0.0, std::nan("")), 0.0, plan),
               std::invalid_argument);
  Eigen::MatrixXd wrong = Eigen::MatrixXd::Zero(9, 2);
  EXPECT_THROW(solver.solve(2, goal, 0.0, wrong), std::invalid_argument);
  plan(1, 0) = std::nan("");
  EXPECT_THROW(solver.solve(2, goal, 0.0, plan), std::invalid_argument);
}

}  // namespace
}  // namespace elte_planner
