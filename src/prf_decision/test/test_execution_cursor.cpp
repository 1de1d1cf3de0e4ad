// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/execution_cursor.hpp"

#include <gtest/gtest.h>

#include <random>

#include "scenario.hpp"

namespace prf_decision {
namespace {

class RandomSkill {
 public:
  explicit RandomSkill(unsigned seed) : random_(seed) {}

  Pose pose() {
    Pose pose;
    for (Eigen::Index i = 0; i < 3; ++i) pose.position[i] = uniform_(random_);
    pose.orientation = Eigen::Quaterniond(uniform_(random_), uniform_(random_), uniform_(random_),
                                          1.5 + uniform_(random_));
    pose.orientation.normalize();
    return pose;
  }

  Trajectory trajectory() {
    Trajectory trajectory;
    Duration time{0};
    for (int i = 0; i < 20; ++i) {
      trajectory.poses.push_back(pose());
      trajectory.times.push_back(time);
      time += from_seconds(0.15 + 0.1 * uniform_(random_));
    }
    return trajectory;
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

TEST(ExecutionCursor, RunsAlongTheNominalTimesAndBack) {
  const Trajectory skill = RandomSkill(1).trajectory();
  double cursor = 0;
  Duration time{0};
  for (; !at_end(skill, cursor); time += kTickPeriod) {
    EXPECT_NEAR(to_seconds(skill.times.back() - time_to_go(skill, cursor)), to_seconds(time), 1e-7);
    cursor = advance_cursor(skill, cursor, Direction::kForward, kTickPeriod);
  }
  EXPECT_EQ(cursor, 19);
  EXPECT_GE(time, skill.times.back());
  EXPECT_LT(time, skill.times.back() + kTickPeriod);
  EXPECT_EQ(advance_cursor(skill, cursor, Direction::kStand, kTickPeriod), cursor);
  const double before = advance_cursor(skill, cursor, Direction::kBack, kTickPeriod);
  EXPECT_NEAR(to_seconds(time_to_go(skill, before)), 0.01, 1e-7);
  EXPECT_EQ(advance_cursor(skill, 0.2, Direction::kBack, std::chrono::seconds(9)), 0);
}

TEST(ExecutionCursor, FreezesTheSegmentBeingExecuted) {
  const Trajectory skill = straight_skill();
  EXPECT_EQ(frozen_nodes(skill, 0), 2u);
  EXPECT_EQ(frozen_nodes(skill, 0.99), 2u);
  EXPECT_EQ(frozen_nodes(skill, 1), 3u);
  EXPECT_EQ(frozen_nodes(skill, 8.5), 10u);
  EXPECT_EQ(frozen_nodes(skill, 9), 11u);
  EXPECT_EQ(frozen_nodes(skill, 10), 11u);
}

TEST(ExecutionCursor, PassesThroughTheNodes) {
  const Trajectory skill = RandomSkill(2).trajectory();
  for (std::size_t i = 0; i < skill.poses.size(); ++i) {
    const MovingPose hand = hand_at(skill, static_cast<double>(i), Direction::kForward);
    EXPECT_LT((hand.pose.position - skill.poses[i].position).norm(), 1e-12);
    EXPECT_LT(hand.pose.orientation.angularDistance(skill.poses[i].orientation), 1e-7);
  }
}

TEST(ExecutionCursor, IsContinuousInPositionAndVelocityAcrossNodes) {
  const Trajectory skill = RandomSkill(3).trajectory();
  for (int i = 1; i < 19; ++i) {
    const MovingPose before = hand_at(skill, i - 1e-9, Direction::kForward);
    const MovingPose after = hand_at(skill, i + 1e-9, Direction::kForward);
    EXPECT_LT((before.pose.position - after.pose.position).norm(), 1e-7);
    EXPECT_LT((before.linear_velocity - after.linear_velocity).norm(), 1e-4);
  }
}

TEST(ExecutionCursor, FeedsForwardTheDerivativeOfThePose) {
  const Trajectory skill = RandomSkill(4).trajectory();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> where(0, 19);
  for (int trial = 0; trial < 200; ++trial) {
    const double cursor = std::floor(where(random)) + 0.5;
    const Duration h = std::chrono::microseconds(10);
    const double next = advance_cursor(skill, cursor, Direction::kForward, h);
    const MovingPose at = hand_at(skill, cursor, Direction::kForward);
    const MovingPose after = hand_at(skill, next, Direction::kForward);
    const Eigen::Vector3d slope = (after.pose.position - at.pose.position) / to_seconds(h);
    EXPECT_LT((slope - at.linear_velocity).norm(), 5e-3 * (1 + at.linear_velocity.norm()));
    const Eigen::Vector3d turn =
        prf_core::rotation_between(at.pose.orientation, after.pose.orientation) / to_seconds(h);
    EXPECT_LT((turn - at.angular_velocity).norm(), 1e-4 * (1 + at.angular_velocity.norm()));
    const MovingPose back = hand_at(skill, cursor, Direction::kBack);
    EXPECT_EQ(back.linear_velocity, -at.linear_velocity);
    EXPECT_EQ(back.angular_velocity, -at.angular_velocity);
  }
}

// The planner may move every node that is not frozen at each tick; the hand must not notice.
TEST(ExecutionCursor, KeepsTheSetPointWhenTheUnfrozenPartChangesAtRandom) {
  RandomSkill nodes(6);
  Trajectory plan = nodes.trajectory();
  std::mt19937 random(7);
  std::discrete_distribution<int> choice({1, 1, 4});
  double cursor = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    Trajectory changed = plan;
    for (std::size_t i = frozen_nodes(plan, cursor); i < plan.poses.size(); ++i) {
      changed.poses[i] = nodes.pose();
    }
    // Also anywhere else in the frozen part, which the way back goes through.
    const auto last = static_cast<double>(frozen_nodes(plan, cursor) - 1);
    for (const double at : {cursor, last, 0.3 * last}) {
      const MovingPose before = hand_at(plan, std::min(at, last - 1e-9), Direction::kForward);
      const MovingPose after = hand_at(changed, std::min(at, last - 1e-9), Direction::kForward);
      ASSERT_EQ(before.pose.position, after.pose.position) << "cursor " << cursor << " at " << at;
      ASSERT_EQ(before.pose.orientation.coeffs(), after.pose.orientation.coeffs());
      ASSERT_EQ(before.linear_velocity, after.linear_velocity);
    }
    plan = changed;
    const auto direction = static_cast<Direction>(choice(random) - 1);
    cursor = advance_cursor(plan, cursor, direction, kTickPeriod);
    if (at_end(plan, cursor)) cursor = 0;
  }
}

TEST(ExecutionCursor, RefusesACursorOutsideTheTrajectory) {
  const Trajectory skill = straight_skill();
  EXPECT_THROW((void)hand_at(skill, -0.1, Direction::kForward), std::invalid_argument);
  EXPECT_THROW((void)hand_at(skill, 10.1, Direction::kForward), std::invalid_argument);
  EXPECT_THROW((void)time_to_go(skill, NAN), std::invalid_argument);
}

}  // namespace
}  // namespace prf_decision
