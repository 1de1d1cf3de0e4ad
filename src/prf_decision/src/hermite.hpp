// SPDX-License-Identifier: BSD-3-Clause
// Private: the interpolation that forecasts and trajectories share.
#pragma once

#include "prf_decision/motion.hpp"

namespace prf_decision {

// Cubic Hermite position from the end velocities, slerp orientation with its constant angular
// velocity; `span` and `time` in s, 0 <= time <= span.
inline MovingPose hermite(const MovingPose& start, const MovingPose& end, double span,
                          double time) {
  const double s = time / span;
  const Eigen::Vector3d p0 = start.pose.position;
  const Eigen::Vector3d p1 = end.pose.position;
  const Eigen::Vector3d m0 = start.linear_velocity * span;
  const Eigen::Vector3d m1 = end.linear_velocity * span;
  MovingPose at;
  at.pose.position =
      p0 + s * m0 + s * s * (3 * (p1 - p0) - 2 * m0 - m1) + s * s * s * (2 * (p0 - p1) + m0 + m1);
  at.linear_velocity =
      (m0 + 2 * s * (3 * (p1 - p0) - 2 * m0 - m1) + 3 * s * s * (2 * (p0 - p1) + m0 + m1)) / span;
  at.pose.orientation = start.pose.orientation.slerp(s, end.pose.orientation);
  at.angular_velocity = rotation_between(start.pose.orientation, end.pose.orientation) / span;
  return at;
}

}  // namespace prf_decision
