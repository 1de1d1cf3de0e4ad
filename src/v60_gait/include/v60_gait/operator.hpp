// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <deque>

namespace v60_gait {

/// The person beside the platform who keeps the stepping robot in its place by joystick. The
/// operator alone sees where the robot is on the deck: every 0.1 s, with a reaction time of 0.7 s,
/// and without reacting to errors below 0.03 m and 0.05 rad. The command is proportional to the
/// smoothed error and bounded. All figures are chosen by hand.
class Operator {
 public:
  /// `place_on_deck`: where base_link shall be, in the platform frame.
  explicit Operator(const Eigen::Isometry3d& place_on_deck) : place_(place_on_deck) {}

  /// Velocity that the joystick commands: m/s ahead, m/s to the left, rad/s. Times must not
  /// decrease.
  [[nodiscard]] Eigen::Vector3d joystick(double time, const Eigen::Isometry3d& robot_on_deck);

 private:
  struct Observation {
    double time;
    Eigen::Vector3d error;  // ahead, left, yaw
  };

  Eigen::Isometry3d place_;
  std::deque<Observation> pending_;  // younger than the reaction time
  Eigen::Vector3d error_ = Eigen::Vector3d::Zero();
};

}  // namespace v60_gait
