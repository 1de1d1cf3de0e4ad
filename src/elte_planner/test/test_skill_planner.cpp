// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/skill_planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "allocation_count.hpp"
#include "random_problems.hpp"

namespace elte_planner {
namespace {

Eigen::VectorXd end_of(const PlanResult& plan) {
  return plan.positions.row(plan.positions.rows() - 1).transpose();
}

class SkillPlannerTest : public testing::TestWithParam<std::string> {
 protected:
  SkillPlannerTest() {
    std::mt19937 random(1);
    demonstration_ = random_demonstration(50, 3, random);
    planner_ = make_skill_planner(GetParam(), demonstration_, {});
    request_.previous = demonstration_;
    request_.goal = demonstration_.row(49).transpose() + Eigen::Vector3d(0.05, -0.1, 0.02);
  }

  Eigen::MatrixXd demonstration_;
  std::unique_ptr<SkillPlanner> planner_;
  PlanRequest request_;
};

TEST_P(SkillPlannerTest, NamesItself) { EXPECT_EQ(planner_->name(), GetParam()); }

TEST_P(SkillPlannerTest, KeepsFrozenRowsAndReachesTheBallOrSaysTheSlack) {
  for (const Eigen::Index frozen : {2, 3, 20, 48, 49}) {
    for (const double radius : {0.0, 0.02, 0.5}) {
      request_.frozen = frozen;
      request_.radius = radius;
      const PlanResult plan = planner_->plan(request_);
      ASSERT_EQ(plan.positions.rows(), 50);
      EXPECT_EQ(plan.positions.topRows(frozen), demonstration_.topRows(frozen));
      const double miss = (end_of(plan) - request_.goal).lpNorm<1>();
      EXPECT_EQ(plan.status, plan.slack > 0.0 ? PlanStatus::kRelaxed : PlanStatus::kSolved);
      EXPECT_NEAR(plan.slack, std::max(miss - radius, 0.0), 1e-12);
      if (planner_->name() != "dmp") {
        EXPECT_EQ(plan.slack, 0.0);
      }
      EXPECT_LE(plan.kkt_residual, 1e-14);
      EXPECT_TRUE(plan.positions.allFinite());
    }
  }
}

TEST_P(SkillPlannerTest, SaysByHowMuchTheEndIsMissedWhenAllIsFrozen) {
  request_.frozen = 50;
  request_.radius = 0.05;
  const PlanResult plan = planner_->plan(request_);
  EXPECT_EQ(plan.status, PlanStatus::kRelaxed);
  EXPECT_NEAR(plan.slack, 0.17 - 0.05, 1e-12);
  EXPECT_EQ(plan.positions, demonstration_);
  request_.radius = 0.2;
  EXPECT_EQ(planner_->plan(request_).status, PlanStatus::kSolved);
}

TEST_P(SkillPlannerTest, RefusesRequestsThatDoNotFit) {
  const auto refused = [this](auto&& change) {
    PlanRequest request = request_;
    change(request);
    EXPECT_THROW((void)planner_->plan(request), std::invalid_argument);
  };
  refused([](PlanRequest& r) { r.frozen = 1; });
  refused([](PlanRequest& r) { r.frozen = 51; });
  refused([](PlanRequest& r) { r.radius = -0.1; });
  refused([](PlanRequest& r) { r.radius = std::nan(""); });
  refused([](PlanRequest& r) { r.goal = Eigen::Vector2d(0.0, 0.0); });
  refused([](PlanRequest& r) { r.goal[1] = std::nan(""); });
  refused([](PlanRequest& r) { r.previous(0, 0) = std::nan(""); });
  refused([](PlanRequest& r) { r.previous = Eigen::MatrixXd::Zero(49, 3); });
}

// Half of it executed, the end moved, a narrowing ball on each of so many of the last nodes.
PlanRequest approach_request(const Eigen::MatrixXd& zeta, std::mt19937& random) {
  PlanRequest request;
  request.previous = zeta;
  request.frozen = 25;
  const Eigen::VectorXd offset = random_vector(3, 0.1, random);
  request.goal = zeta.row(49).transpose() + offset;
  request.radius = 0.001;
  for (auto k = std::uniform_int_distribution<Eigen::Index>(26, 46)(random); k < 49; ++k) {
    request.approach.push_back(
        {k, zeta.row(k).transpose() + offset, 0.001 * static_cast<double>(50 - k)});
  }
  return request;
}

// What every planner must make of an approach whose target has moved: the demonstrated line before
// the target, where the target will be.
TEST_P(SkillPlannerTest, FollowsTheTargetAlongTheApproach) {
  const PlanResult still =
      planner_->plan({demonstration_, 2, demonstration_.row(49).transpose(), 0.0});
  request_.radius = 0.001;
  for (Eigen::Index k = 30; k < 49; ++k) {
    const Eigen::Vector3d moved(0.05, -0.002 * static_cast<double>(k), 0.02);
    request_.approach.push_back({k, demonstration_.row(k).transpose() + moved, 0.001});
  }
  request_.goal = demonstration_.row(49).transpose() + Eigen::Vector3d(0.05, -0.098, 0.02);
  const PlanResult plan = planner_->plan(request_);
  for (const NodeBall& ball : request_.approach) {
    // As near as it keeps the demonstration without any change.
    const double own = (still.positions.row(ball.node) - demonstration_.row(ball.node)).lpNorm<1>();
    const double miss = (plan.positions.row(ball.node).transpose() - ball.centre).lpNorm<1>();
    EXPECT_LE(miss, (planner_->name() == "elte" ? 0.0 : own) + 0.002) << ball.node;
  }
  // Made again after some of it is executed, the plan goes on as before, but for the velocity that
  // a movement primitive takes from the difference of two nodes.
  PlanRequest again = request_;
  again.previous = plan.positions;
  again.frozen = 20;
  const double change = (planner_->plan(again).positions - plan.positions).cwiseAbs().maxCoeff();
  EXPECT_LE(change, planner_->name() == "dmp" ? 0.005 : 0.002);
}

TEST(ElteSkillPlanner, PlansTheSameWhateverItPlannedBefore) {
  std::mt19937 random(5);
  const Eigen::MatrixXd zeta = random_demonstration(50, 3, random);
  const auto planner = make_skill_planner("elte", zeta, {});
  for (int i = 0; i < 20; ++i) {
    const PlanRequest request = approach_request(zeta, random);
    const PlanResult plan = planner->plan(request);
    EXPECT_EQ(plan.positions, make_skill_planner("elte", zeta, {})->plan(request).positions);
    EXPECT_LE(plan.kkt_residual, 1e-14);
  }
}

#ifdef ELTE_PLANNER_COUNTS_ALLOCATIONS
TEST(ElteSkillPlanner, AllocatesNothingButItsPlan) {
  std::mt19937 random(6);
  const Eigen::MatrixXd zeta = random_demonstration(50, 3, random);
  const auto planner = make_skill_planner("elte", zeta, {});
  const PlanRequest request = approach_request(zeta, random);
  ASSERT_EQ(planner->plan(request).status, PlanStatus::kSolved);
  const long before = g_allocations;
  const PlanResult plan = planner->plan(request);
  EXPECT_LE(g_allocations - before, 2);
}
#endif

TEST(StepBound, IsKeptAndOpensTheRadiusOnlyByWhatIsMissing) {
  std::mt19937 random(3);
  int relaxed = 0;
  int solved = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::MatrixXd zeta = random_demonstration(30, 3, random);
    const double max_step =
        1.2 * (zeta.bottomRows(29) - zeta.topRows(29)).rowwise().lpNorm<1>().maxCoeff();
    const Eigen::Index frozen = std::uniform_int_distribution<Eigen::Index>(2, 29)(random);
    const PlanRequest request{zeta, frozen,
                              zeta.row(29).transpose() + random_vector(3, 0.5, random), 0.01};
    const PlanResult plan =
        make_skill_planner(i % 2 == 0 ? "elte" : "lte", zeta, {}, {max_step})->plan(request);
    ASSERT_NE(plan.status, PlanStatus::kFailed) << i << ": " << plan.message;
    ASSERT_EQ(plan.positions.topRows(frozen), zeta.topRows(frozen));
    for (Eigen::Index k = frozen; k < 30; ++k) {
      ASSERT_LE((plan.positions.row(k) - plan.positions.row(k - 1)).lpNorm<1>(), max_step + 1e-11);
    }
    ASSERT_LE((end_of(plan) - request.goal).lpNorm<1>(), 0.01 + plan.slack + 1e-11);
    const double distance = (request.goal - zeta.row(frozen - 1).transpose()).lpNorm<1>();
    const double missing = distance - 0.01 - max_step * static_cast<double>(30 - frozen);
    ASSERT_NEAR(plan.slack, std::max(missing, 0.0), 1e-5) << i;
    ASSERT_EQ(plan.status, plan.slack > 0.0 ? PlanStatus::kRelaxed : PlanStatus::kSolved);
    ++(plan.slack > 0.0 ? relaxed : solved);
  }
  EXPECT_GT(relaxed, 50);
  EXPECT_GT(solved, 50);
}

TEST(StepBound, IsRefusedByPlannersThatKeepNone) {
  std::mt19937 random(4);
  const Eigen::MatrixXd zeta = random_demonstration(30, 3, random);
  for (const char* name : {"dmp", "elastic_map"}) {
    EXPECT_THROW((void)make_skill_planner(name, zeta, {}, {0.1}), std::invalid_argument);
  }
  EXPECT_THROW((void)make_skill_planner("elte", zeta, {}, {0.0}), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Planners, SkillPlannerTest, testing::ValuesIn(planner_names()));

Eigen::MatrixXd corner() {
  Eigen::MatrixXd path(100, 2);
  for (Eigen::Index k = 0; k < 100; ++k) {
    const double s = static_cast<double>(k) / 99.0;
    path.row(k) << std::min(s, 0.5), std::max(s - 0.5, 0.0);
  }
  return path;
}

TEST(LaplacianTrajectoryEditing, ReproducesTheDemonstrationForItsOwnGoal) {
  PlanRequest request{corner(), 2, corner().row(99).transpose(), 0.0};
  const PlanResult plan = make_skill_planner("lte", corner(), {})->plan(request);
  EXPECT_LE((plan.positions - corner()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ElasticMap, PullsBackToThePlaceOfTheDemonstration) {
  Eigen::VectorXd goal = corner().row(99).transpose();
  goal[0] += 0.1;
  const PlanRequest request{corner(), 2, goal, 0.0};
  const PlanResult plan = make_skill_planner("elastic_map", corner(), {})->plan(request);
  EXPECT_LE((plan.positions - corner()).topRows(95).cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_EQ(plan.positions.row(99).transpose(), goal);
}

TEST(DynamicMovementPrimitive, FollowsItsDemonstrationAndApproachesAChangedGoal) {
  const auto planner = make_skill_planner("dmp", corner(), {});
  PlanRequest request{corner(), 2, corner().row(99).transpose(), 0.0};
  const PlanResult same = planner->plan(request);
  EXPECT_LE((same.positions - corner()).rowwise().norm().maxCoeff(), 0.1);
  request.frozen = 30;
  request.goal[0] += 0.5;
  const PlanResult moved = planner->plan(request);
  const double before = (same.positions.row(99).transpose() - request.goal).norm();
  EXPECT_LE((moved.positions.row(99).transpose() - request.goal).norm(), 0.5 * before);
}

TEST(DynamicMovementPrimitive, IsPushedOffAnObstacleBesideItsWay) {
  const auto planner = make_skill_planner("dmp", corner(), {});
  PlanRequest request{corner(), 2, corner().row(99).transpose(), 0.05};
  const PlanResult free = planner->plan(request);
  request.clearance = 0.03;
  request.obstacles = {Obstacle::disc(Eigen::Vector2d(0.3, 0.06), 0.05)};
  ASSERT_LT(plan_clearance(free.positions, 2, request.obstacles, {}), request.clearance);
  const PlanResult around = planner->plan(request);
  ASSERT_EQ(around.status, PlanStatus::kSolved) << around.message;
  EXPECT_GE(plan_clearance(around.positions, 2, request.obstacles, {}), request.clearance);
  EXPECT_LE((around.positions.row(99) - free.positions.row(99)).norm(), 0.02);
  request.obstacles = {Obstacle::disc(Eigen::Vector2d(0.5, 0.5), 0.05)};  // over the goal
  const PlanResult before_it = planner->plan(request);
  EXPECT_EQ(before_it.status, PlanStatus::kRelaxed);
  EXPECT_GE(plan_clearance(before_it.positions, 2, request.obstacles, {}), request.clearance);
  request.obstacles = {Obstacle::disc(Eigen::Vector2d(0.02, 0.0), 0.05)};  // over the start
  EXPECT_EQ(planner->plan(request).status, PlanStatus::kNoWay);
}

TEST(SkillPlannerFactory, ListsTheKnownNamesWhenRefusing) {
  std::mt19937 random(2);
  const Eigen::MatrixXd demonstration = random_demonstration(10, 3, random);
  try {
    (void)make_skill_planner("splines", demonstration, {});
    FAIL() << "accepted an unknown planner";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("splines"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("elte"), std::string::npos);
  }
}

}  // namespace
}  // namespace elte_planner
