// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <deque>

namespace v60_gait {

/// The operator beside the platform, who keeps the stepping robot in its place with the stick. This
/// is the one part of locomotion that sees where the robot is on the deck: by eye, late, and not
/// minding small errors.
class Operator {
 public:
  explicit Operator(const Eigen::Isometry3d& place_on_deck) : place_(place_on_deck) {}

  /// Velocity that the stick asks for: m/s ahead, m/s to the left, rad/s. Times must not decrease.
  [[nodiscard]] Eigen::Vector3d stick(double time, const Eigen::Isometry3d& robot_on_deck);

 private:
  struct Look {
    double time;
    Eigen::Vector3d error;  // ahead, left, yaw
  };

  Eigen::Isometry3d place_;
  std::deque<Look> looks_;  // not yet reacted to
  Eigen::Vector3d error_ = Eigen::Vector3d::Zero();
};

}  // namespace v60_gait
