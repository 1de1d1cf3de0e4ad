// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/view_keeper.hpp"

#include <cmath>
#include <optional>

namespace prf_decision {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Where the target belongs in the hand's frame, `line_of_sight` m away; none: too near.
std::optional<Vector3d> centred(const Pose& goal_in_target, double line_of_sight) {
  Vector3d place = -(goal_in_target.orientation.conjugate() * goal_in_target.position);
  Eigen::Index axis = 0;
  const double ahead = place.cwiseAbs().maxCoeff(&axis);
  const double beside = place.squaredNorm() - ahead * ahead;
  const double depth = line_of_sight * line_of_sight - beside;
  if (!(depth > 0)) return std::nullopt;
  place[axis] = std::copysign(std::sqrt(depth), place[axis]);
  return place;
}

Quaterniond turned(const Quaterniond& planned, const Vector3d& line_of_sight,
                   const Pose& goal_in_target, double view_angle) {
  const auto place = centred(goal_in_target, line_of_sight.norm());
  if (!place) return planned;
  const Eigen::AngleAxisd off(Quaterniond::FromTwoVectors(planned * *place, line_of_sight));
  const double angle = off.angle() - view_angle * std::tanh(off.angle() / view_angle);
  return (Quaterniond(Eigen::AngleAxisd(angle, off.axis())) * planned).normalized();
}

}  // namespace

Quaterniond looking_along(const Quaterniond& planned, const Vector3d& line_of_sight,
                          const Pose& goal_in_target) {
  constexpr double kExact = 1e-6;  // rad
  return turned(planned, line_of_sight, goal_in_target, kExact);
}

MovingPose kept_in_view(const MovingPose& planned, const Vector3d& from, const MovingPose& target,
                        const Pose& goal_in_target, double view_angle) {
  if (!(view_angle < M_PI)) return planned;
  constexpr double kStep = 1e-3;  // s, over which the turning is differenced
  const Vector3d line_of_sight = target.pose.position - from;
  const Vector3d later = line_of_sight + kStep * (target.linear_velocity - planned.linear_velocity);
  const Quaterniond planned_later =
      prf_core::exp_so3(kStep * planned.angular_velocity) * planned.pose.orientation;

  MovingPose hand = planned;
  hand.pose.orientation =
      turned(planned.pose.orientation, line_of_sight, goal_in_target, view_angle);
  hand.angular_velocity =
      prf_core::rotation_between(hand.pose.orientation,
                                 turned(planned_later, later, goal_in_target, view_angle)) /
      kStep;
  return hand;
}

}  // namespace prf_decision
