// SPDX-License-Identifier: BSD-3-Clause
// Keeps the target in the camera's view while the hand is on its way. The camera looks along that
// axis of the hand which is nearest to the line of sight at the skill's goal; as far beside this
// axis as the target is there, it belongs. A planned hand is turned, by the shortest rotation,
// until it has the target there but for
//   view_angle tanh(b / view_angle),
// b the angle by which it is off: a demonstration that sees the target keeps its orientations, one
// that looks away is turned. At the goal b = 0.
#pragma once

#include "prf_decision/types.hpp"

namespace prf_decision {

// `planned` turned; its angular velocity is that of the turning hand. The line of sight is from
// `from` (m, where the hand is about to be) to the `target`; both frames move. `goal_in_target`:
// the hand at the end of the skill in the target's frame. `view_angle` in rad, above 0; pi or more
// leaves the hand as planned, as does a target nearer than it belongs beside the axis.
[[nodiscard]] MovingPose kept_in_view(const MovingPose& planned, const Eigen::Vector3d& from,
                                      const MovingPose& target, const Pose& goal_in_target,
                                      double view_angle);

// `planned` turned so that the camera looks along `line_of_sight` (m, to a target).
[[nodiscard]] Eigen::Quaterniond looking_along(const Eigen::Quaterniond& planned,
                                               const Eigen::Vector3d& line_of_sight,
                                               const Pose& goal_in_target);

}  // namespace prf_decision
