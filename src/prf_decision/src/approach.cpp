// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/approach.hpp"

#include <algorithm>

namespace prf_decision {
namespace {

bool same(const Pose& a, const Pose& b) {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

Pose in_frame(const Pose& frame, const Pose& pose) {
  const Eigen::Quaterniond inverse = frame.orientation.conjugate();
  return {inverse * (pose.position - frame.position), (inverse * pose.orientation).normalized()};
}

// A frame that moves within a moving carrier.
MovingPose carried(const MovingPose& carrier, const MovingPose& frame_in_carrier) {
  MovingPose frame = prf_core::rigidly_attached(carrier, frame_in_carrier.pose);
  frame.linear_velocity += carrier.pose.orientation * frame_in_carrier.linear_velocity;
  frame.angular_velocity += carrier.pose.orientation * frame_in_carrier.angular_velocity;
  return frame;
}

}  // namespace

void Approach::update(const Trajectory& plan, double cursor, Stamp stamp,
                      const TargetForecast& forecast) {
  const Duration elapsed = plan.times.back() - time_to_go(plan, cursor);
  std::vector<Pose> anchors(plan.poses.size());
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    const bool kept = k < plan_.poses.size() && same(plan.poses[k], plan_.poses[k]);
    const Duration ahead = std::max(plan.times[k] - elapsed, Duration{0});
    anchors[k] =
        kept ? anchors_.poses[k]
             : in_frame(predicted_target(forecast, stamp + ahead).target.pose, plan.poses[k]);
  }
  plan_ = plan;
  anchors_ = {std::move(anchors), plan.times, plan.goal_in_target};
}

double Approach::weight(double cursor, double length) const {
  if (length == 0 || plan_.poses.empty()) return 0;
  const Pose hand = hand_at(anchors_, cursor, Direction::kStand).pose;
  const double distance = (hand.position - plan_.goal_in_target.position).norm();
  const double s = std::clamp(2 - distance / length, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

MovingPose Approach::hand(double cursor, Direction direction, const MovingPose& target,
                          double length) const {
  const MovingPose planned = hand_at(plan_, cursor, direction);
  const MovingPose with_target = carried(target, hand_at(anchors_, cursor, direction));
  const double w = weight(cursor, length);
  const auto blend = [w](const Eigen::Vector3d& a, const Eigen::Vector3d& b) -> Eigen::Vector3d {
    return (1 - w) * a + w * b;
  };
  return {{blend(planned.pose.position, with_target.pose.position),
           planned.pose.orientation.slerp(w, with_target.pose.orientation)},
          blend(planned.linear_velocity, with_target.linear_velocity),
          blend(planned.angular_velocity, with_target.angular_velocity)};
}

}  // namespace prf_decision
