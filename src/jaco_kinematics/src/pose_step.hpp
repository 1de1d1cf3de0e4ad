// SPDX-License-Identifier: BSD-3-Clause
// One Newton step to a pose and the self-motion beside it. Private to the library.
#pragma once

#include "geometry.hpp"

namespace jaco_kinematics {

// [rad] in the norm of q. Ours: longer steps are shortened to this, over which the pose is still
// nearly linear in q.
constexpr double kLargestStep = 0.3;

struct PoseStep {
  JointVector least;        // the shortest dq with J dq = difference
  JointVector self_motion;  // unit joint motion that does not move the hand, up to its sign
};

// `difference` as pose_difference() gives it, from the frames' end effector.
PoseStep pose_step(const Frames& frames, const Eigen::Matrix<double, 6, 1>& difference);

}  // namespace jaco_kinematics
