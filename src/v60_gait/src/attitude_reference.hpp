// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace v60_gait {

/// Desired attitude of the body on a sloping deck, relative to level: a part of the slope through a
/// first-order lag, plus roll and yaw in proportion to the body's lateral offset over its feet.
class AttitudeReference {
 public:
  struct Gains {
    double leaning = 1.0;  ///< part of the deck's slope that the body follows
    double lag = 0.0;      ///< s
    double banking = 0.0;  ///< rad of roll per m of offset to the right
    double heading = 0.0;  ///< rad of yaw per m of offset to the right
  };

  explicit AttitudeReference(const Gains& gains) : gains_(gains) {}

  /// `slope`: pitch and roll of the deck, rad; `side`: lateral offset of the body to the left, m.
  void update(const Eigen::Vector2d& slope, double side, double duration) {
    if (duration > 0.0)
      lean_ += duration / (gains_.lag + duration) * (gains_.leaning * slope - lean_);
    side_ = side;
  }

  [[nodiscard]] Eigen::Quaterniond attitude(double yaw) const {
    return Eigen::AngleAxisd(yaw - gains_.heading * side_, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(lean_[0], Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(lean_[1] - gains_.banking * side_, Eigen::Vector3d::UnitX());
  }

 private:
  Gains gains_;
  Eigen::Vector2d lean_ = Eigen::Vector2d::Zero();
  double side_ = 0.0;
};

}  // namespace v60_gait
