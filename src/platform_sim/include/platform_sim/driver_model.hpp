// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace platform_sim {

/// One entry for each joint of the arm, from base to hand; 8 at most.
using ArmVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 8, 1>;

/// How an arm's driver carries out what it is sent.
struct DriverModel {
  enum class Takes { kVelocities, kPositions, kTrajectories };

  Takes takes = Takes::kVelocities;
  double latency = 0.0;      ///< s, from a message to the arm
  double take_period = 0.0;  ///< s, between two messages that are taken; 0: the newest one counts
  std::size_t queue = 1;     ///< messages that wait at most; of more the oldest is lost
  double lifetime = 0.0;     ///< s, for which a velocity lasts; 0: until the next one
  double servo_gain = 0.0;   ///< 1/s, to the positions; of velocities not used

  /// Throws std::invalid_argument with name, value and bound.
  void validate() const;
};

/// One message to a driver.
struct DriverPoint {
  ArmVector positions;    ///< rad
  ArmVector velocities;   ///< rad/s
  double duration = 0.0;  ///< s, of trajectories: until positions are reached
};

}  // namespace platform_sim
