// SPDX-License-Identifier: BSD-3-Clause
// A motion may change: a wave gets faster, a platform stops, a target at rest begins to move.
// Forecasts that were made before know nothing of it, and the errors of the past say nothing about
// those to come.
//
// The unit m stands for rad where orientations are predicted (rotation_predictor.hpp).
//
// 1. Before a change. With v^2 the mean square of the measured velocity and s^2 the variance of the
//    position over the last kMemory, a forecast of age a has at least the variance
//      k^2 max(min((v a)^2, 2 s^2), (v_0 a)^2)   of each axis, k = kShare, v_0 = kLeastSpeed,
//    which is that of a change of the whole velocity between one image in 1 / k^2 and the next.
// 2. A change. The error e of a prediction that came due (an innovation, or a short forecast) shows
// one when e^2 beside the variance that was expected exceeds kSurprise,
//    mean of the axes.
#pragma once

#include <Eigen/Core>

namespace prf_predictor {

// An error that was seen, and what was thought of it before.
struct ObservedError {
  Eigen::Array3d squared = Eigen::Array3d::Zero();   // e^2, m^2
  Eigen::Array3d expected = Eigen::Array3d::Ones();  // its variance, m^2
  [[nodiscard]] double ratio() const { return (squared / expected).mean(); }
};

class MotionChange {
 public:
  static constexpr double kShare = 0.055;
  static constexpr double kLeastSpeed = 0.07;  // m/s
  static constexpr double kMemory = 6.0;       // s
  static constexpr double kSurprise = 16.0;    // a robot's touch-downs stay below

  void begin(const Eigen::Vector3d& position);
  // A measurement `elapsed` s after the one before. `noise`: its variance.
  void observe(const Eigen::Vector3d& position, const Eigen::Vector3d& noise, double elapsed);
  // Whether the error shows a change.
  [[nodiscard]] static bool is_shown_by(const ObservedError& error);

  [[nodiscard]] Eigen::Array3d least_variance(double age) const;  // m^2

 private:
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  Eigen::Array3d spread2_ = Eigen::Array3d::Zero();
  Eigen::Array3d speed2_ = Eigen::Array3d::Zero();
};

}  // namespace prf_predictor
