// SPDX-License-Identifier: BSD-3-Clause
#include "task_error.hpp"

#include <prf_core/se3.hpp>

namespace arm_kinematics {
namespace {

Eigen::Vector3d turn_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to,
                             Task task) {
  if (task == Task::kPose) {
    return prf_core::log_so3(Eigen::Quaterniond(to.linear() * from.linear().transpose()));
  }
  return prf_core::log_so3(
      Eigen::Quaterniond::FromTwoVectors(from.linear().col(2), to.linear().col(2)));
}

}  // namespace

TaskError task_error(const Placement& placement, const Eigen::Isometry3d& goal, Task task) {
  TaskError result;
  result.value << goal.translation() - placement.tip.translation(),
      turn_between(placement.tip, goal, task);
  result.jacobian = placement.jacobian;
  if (task == Task::kPositionAndAxis) {
    const Eigen::Vector3d z = placement.tip.linear().col(2);
    result.jacobian.bottomRows<3>() -= z * (z.transpose() * placement.jacobian.bottomRows<3>());
  }
  return result;
}

PoseError size_of(const TaskError& error) {
  return {error.value.head<3>().norm(), error.value.tail<3>().norm()};
}

PoseError error_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, Task task) {
  return {(to.translation() - from.translation()).norm(), turn_between(from, to, task).norm()};
}

}  // namespace arm_kinematics
