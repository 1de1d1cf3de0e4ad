// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/approach.hpp"

#include <gtest/gtest.h>

#include "executive/executive_world.hpp"

namespace prf_decision {
namespace {

TEST(Approach, FollowsThePlanWhileTheTargetMovesAsForecastAndTheTargetWhereItDoesNot) {
  const Trajectory plan = straight_skill();
  const Stamp start = from_seconds(5);
  const TargetForecast forecast = forecast_of(start, kTarget, {0.1, 0.2, 0});
  Approach approach;
  EXPECT_EQ(approach.weight(10, 0.1), 0);
  approach.update(plan, 6, start, forecast);
  for (const double cursor : {6.0, 7.0, 9.0, 10.0}) {
    MovingPose target = predicted_target(forecast, start + from_seconds(0.1 * (cursor - 6))).target;
    const Eigen::Vector3d planned = hand_at(plan, cursor, Direction::kForward).pose.position;
    const auto position = [&] {
      return approach.hand(cursor, Direction::kForward, target, 0.3).pose.position;
    };
    EXPECT_LT((position() - planned).norm(), 1e-12) << cursor;
    target.pose.position.y() += 0.05;
    EXPECT_LT((position() - planned - Eigen::Vector3d(0, 0.05, 0)).norm(), 1e-12) << cursor;
  }
  approach.update(plan, 6, start, forecast_of(start, kTarget, kStill));
  EXPECT_LT((approach.hand(10, Direction::kStand, predicted_target(forecast, start).target, 0.3)
                 .pose.position -
             plan.poses[10].position + 0.4 * Eigen::Vector3d(0.1, 0.2, 0))
                .norm(),
            1e-12)
      << "a node that a new plan leaves where it is keeps its anchor";
}

// Nodes are 30 mm apart: 150 mm before the goal the skill is half of the plan and half of the
// target.
TEST(Approach, BlendsOverItsOwnLengthBeforeIt) {
  Approach approach;
  approach.update(straight_skill(), 0, Stamp{0}, forecast_of(Stamp{0}, kTarget, kStill));
  EXPECT_EQ(approach.weight(3.3, 0.1), 0);
  EXPECT_NEAR(approach.weight(5, 0.1), 0.5, 1e-9);
  EXPECT_EQ(approach.weight(6.7, 0.1), 1);
  EXPECT_EQ(approach.weight(10, 0), 0);
}

}  // namespace
}  // namespace prf_decision
