// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace platform_sim {

/// Pose and twist of a frame in world. `linear` is the velocity of the frame's origin, m/s, and
/// `angular` its rate, rad/s; both are written in world axes.
struct FrameState {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
};

}  // namespace platform_sim
