// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "platform_sim/world.hpp"

namespace motion_capture {

/// What an observer with motion capture sees of the robot at one instant. Body: the point 30 mm
/// above base_link's origin, where the markers of the real robot have their centre.
struct MotionSample {
  double time = 0.0;                                         ///< s
  double deck_sway = 0.0;                                    ///< m
  double deck_pitch = 0.0;                                   ///< rad
  Eigen::Vector3d body = Eigen::Vector3d::Zero();            ///< m, in the platform frame
  Eigen::Vector3d roll_pitch_yaw = Eigen::Vector3d::Zero();  ///< rad, body in platform
  Eigen::Vector3d tag = Eigen::Vector3d::Zero();             ///< m, in the body frame
  Eigen::Vector4d toe_heights = Eigen::Vector4d::Zero();     ///< m, over the deck; fl, fr, rl, rr
};

/// Samples at 100 Hz without gaps.
using MotionPiece = std::vector<MotionSample>;

/// One window of time, in pieces. Peak to peak is over all pieces together.
struct MotionFigures {
  Eigen::Vector3d body_range = Eigen::Vector3d::Zero();      ///< m, peak to peak
  Eigen::Vector3d rotation_range = Eigen::Vector3d::Zero();  ///< rad, peak to peak
  Eigen::Vector3d tag_range = Eigen::Vector3d::Zero();       ///< m, peak to peak
  double tag_speed_rms = 0.0;                                ///< m/s, below 8 Hz
  double tag_speed_p95 = 0.0;                                ///< m/s
  double cadence = 0.0;                                      ///< strides/s, 0 if it does not step
  double duty = 1.0;  ///< part of a stride that a toe is less than 12 mm above its lowest place
  double lift = 0.0;  ///< m, median over the steps of the highest place
};

/// Throws std::invalid_argument if there is no piece or one has fewer than 10 samples.
[[nodiscard]] MotionFigures measure_motion(const std::vector<MotionPiece>& pieces);

/// Amplitude of each axis of the tag in the body frame, m, at `rates`, rad/s, by least squares
/// together with a constant; the last column is the standard deviation of what is left.
[[nodiscard]] Eigen::Matrix3Xd tag_lines(const std::vector<MotionPiece>& pieces,
                                         const std::vector<double>& rates);

/// Watches a world at 100 Hz.
class MotionObserver {
 public:
  /// Steps the world by 10 ms and adds a sample. `before`: called before each step of the physics.
  void step(platform_sim::World& world,
            const std::function<void(platform_sim::World&)>& before = {});

  [[nodiscard]] const MotionPiece& samples() const { return samples_; }
  /// Mean over the toes of the way that they have slid on the deck, m.
  [[nodiscard]] double slip() const { return slip_; }

 private:
  MotionPiece samples_;
  double slip_ = 0.0;
};

}  // namespace motion_capture
