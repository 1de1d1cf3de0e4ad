// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/edit_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "random_problems.hpp"

namespace elte_planner {
namespace {

TEST(EditProblem, IsRefusedWhenInvalid) {
  std::mt19937 random(9);
  EditProblem problem;
  problem.zeta = random_demonstration(30, 3, random);
  problem.fixed = problem.zeta.topRows(5);
  const Eigen::VectorXd end = problem.zeta.row(29).transpose();
  const auto refused = [&](auto&& change) {
    EditProblem bad = problem;
    bad.constraints = {PointConstraint::ball(29, end, 0.1)};
    change(bad);
    EXPECT_THROW((void)solve(bad), std::invalid_argument);
  };
  EXPECT_EQ(solve(problem).status, EditStatus::kSolved);
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
