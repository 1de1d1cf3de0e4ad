// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/view_keeper.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace prf_decision {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// 0.3 m in front of the target, which is 0.05 m beside the hand's z axis there.
const Pose kGoalInTarget{{0.3, 0, 0.05}, Quaterniond(AngleAxisd(-M_PI / 2, Vector3d::UnitY()))};
const MovingPose kTarget{
    {{1, 0.2, 0.6}, Quaterniond(AngleAxisd(0.3, Vector3d::UnitZ()))}, {0.1, -0.2, 0}, {0, 0, 0.1}};

Vector3d in_hand(const Pose& hand, const Vector3d& point) {
  return hand.orientation.conjugate() * (point - hand.position);
}

Vector3d belongs() { return in_hand(kGoalInTarget, Vector3d::Zero()); }

// The hand at the goal, moved back by 0.4 m and turned by `angle` about its own `axis`.
MovingPose hand_off_by(double angle, const Vector3d& axis) {
  MovingPose hand = prf_core::rigidly_attached(kTarget, kGoalInTarget);
  const Vector3d z = hand.pose.orientation * Vector3d::UnitZ();
  hand.pose.position -= 0.4 * z;
  hand.pose.orientation = hand.pose.orientation * Quaterniond(AngleAxisd(angle, axis));
  return hand;
}

double beside(const MovingPose& hand) {
  return (in_hand(hand.pose, kTarget.pose.position) - belongs()).head<2>().norm();
}

MovingPose kept(const MovingPose& hand, double view_angle = 0.05) {
  return kept_in_view(hand, hand.pose.position, kTarget, kGoalInTarget, view_angle);
}

TEST(ViewKeeper, TurnsAHandThatLooksAwayUntilTheTargetIsInView) {
  for (const double angle : {0.2, 0.6, 1.5, 2.8}) {
    const MovingPose hand = hand_off_by(angle, Vector3d(1, 2, 0).normalized());
    EXPECT_GT(beside(hand), 0.12);
    EXPECT_LT(beside(kept(hand)), 0.7 * 0.0501) << angle;
    EXPECT_EQ(kept(hand).pose.position, hand.pose.position);
  }
}

TEST(ViewKeeper, LeavesAHandThatSeesTheTarget) {
  const MovingPose goal = prf_core::rigidly_attached(kTarget, kGoalInTarget);
  EXPECT_LT(kept(goal).pose.orientation.angularDistance(goal.pose.orientation), 1e-9);
  const MovingPose hand = hand_off_by(0.01, Vector3d::UnitX());
  EXPECT_LT(kept(hand).pose.orientation.angularDistance(hand.pose.orientation), 2e-4);
  const MovingPose away = hand_off_by(1.0, Vector3d::UnitX());
  EXPECT_EQ(kept(away, 3.2).pose.orientation.coeffs(), away.pose.orientation.coeffs());
}

TEST(ViewKeeper, TurningAboutTheLineOfSightIsTheSkillsOwn) {
  const MovingPose hand = hand_off_by(0, Vector3d::UnitX());
  const Vector3d sight = (kTarget.pose.position - hand.pose.position).normalized();
  MovingPose rolled = hand;
  rolled.pose.orientation = Quaterniond(AngleAxisd(1.2, sight)) * hand.pose.orientation;
  EXPECT_LT(kept(rolled).pose.orientation.angularDistance(rolled.pose.orientation), 1e-9);
}

TEST(ViewKeeper, AngularVelocityIsThatOfTheTurningHand) {
  MovingPose hand = hand_off_by(0.6, Vector3d::UnitX());
  hand.linear_velocity = {0, 0.1, 0.3};
  hand.angular_velocity = {0.1, 0.2, -0.3};
  const double step = 1e-5;
  MovingPose later = hand;
  later.pose.position += step * hand.linear_velocity;
  later.pose.orientation = prf_core::exp_so3(step * hand.angular_velocity) * hand.pose.orientation;
  MovingPose target = kTarget;
  target.pose.position += step * kTarget.linear_velocity;
  const MovingPose next = kept_in_view(later, later.pose.position, target, kGoalInTarget, 0.05);
  const Vector3d rate =
      prf_core::rotation_between(kept(hand).pose.orientation, next.pose.orientation) / step;
  EXPECT_LT((kept(hand).angular_velocity - rate).norm(), 5e-3);
  EXPECT_GT((rate - hand.angular_velocity).norm(), 0.1);
}

TEST(ViewKeeper, ATargetAtTheHandTurnsNothing) {
  const MovingPose hand = hand_off_by(0.6, Vector3d::UnitX());
  MovingPose target = kTarget;
  target.pose.position = hand.pose.position + Vector3d(0.01, 0, 0);
  const MovingPose result = kept_in_view(hand, hand.pose.position, target, kGoalInTarget, 0.05);
  EXPECT_EQ(result.pose.orientation.coeffs(), hand.pose.orientation.coeffs());
}

}  // namespace
}  // namespace prf_decision
