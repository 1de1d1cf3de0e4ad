// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "platform_sim/recorded_motion.hpp"

namespace platform_sim {

/// Recorded motion of a robot's body relative to the deck it stood on. Columns, all required:
/// x, y, z (m) of base_link in the platform frame and roll, pitch, yaw (rad), the rotation being
/// Rz(yaw) Ry(pitch) Rx(roll). Bounds: 1 m from the deck's centre, 0.2 to 1 m over it, 0.7 rad of
/// roll and pitch; 3 m/s, 10 rad/s.
class BodyMotion {
 public:
  /// Throws std::invalid_argument with file, column, value and bound.
  explicit BodyMotion(const std::string& csv_path);

  /// base_link in the platform frame; at rest up to time 0.
  [[nodiscard]] Eigen::Isometry3d base_in_platform(double time) const;

 private:
  RecordedMotion recording_;
};

}  // namespace platform_sim
