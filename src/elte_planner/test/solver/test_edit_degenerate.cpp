// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "edit_problems.hpp"

namespace elte_planner {
namespace {

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

}  // namespace
}  // namespace elte_planner
