// SPDX-License-Identifier: BSD-3-Clause
// Private: the error of a pose and how the joints change it, for either task.
#pragma once

#include "arm_kinematics/arm_kinematics.hpp"

namespace arm_kinematics {

struct TaskError {
  Twist value;        // [m; rad] from the tip to the goal
  Jacobian jacobian;  // of what the task asks for
};

// For kPositionAndAxis the rotation is the smallest that takes one z axis to the other, and the
// Jacobian has no turn about the tip's own z axis.
TaskError task_error(const Placement& placement, const Eigen::Isometry3d& goal, Task task);

PoseError size_of(const TaskError& error);

}  // namespace arm_kinematics
