// SPDX-License-Identifier: BSD-3-Clause
// A motion may change: a wave gets faster, a platform stops. Forecasts that were made before know
// nothing of it, and the errors of the past say nothing about those to come.
//
// 1. Before a change. With h changes a second, v^2 the mean square of the measured velocity and s^2
//    the variance of the position over the last kMemory, a forecast of age a has at least the
//    variance
//      min(h a, 1) min((v a)^2, 2 s^2)   of each axis.
// 2. After a change. With q the mean over the axes of e^2 / (p + r), where e is an innovation or
// the
//    error of a published forecast that came due, p its calibrated variance and r that of the
//    measurement,
//      f <- max(1, 1 + (f - 1) exp(-dt / kRecovery), q / kUsual)
//    is the factor on all variances. While f > kChanged the motion is another one: what was learnt
//    of the candidates is forgotten quickly.
#pragma once

#include <Eigen/Core>

namespace prf_predictor {

class MotionChange {
 public:
  static constexpr double kRate = 0.1;      // h, 1/s
  static constexpr double kMemory = 6.0;    // s
  static constexpr double kUsual = 3.0;     // q up to which nothing has changed
  static constexpr double kRecovery = 0.7;  // s
  static constexpr double kChanged = 8.0;

  void begin(const Eigen::Vector3d& position);
  // A measurement `elapsed` s after the one before. `noise`: r. `ratio`: q.
  void observe(const Eigen::Vector3d& position, const Eigen::Vector3d& noise, double elapsed,
               double ratio);

  [[nodiscard]] Eigen::Array3d least_variance(double age) const;  // m^2
  [[nodiscard]] double factor() const { return factor_; }         // f
  [[nodiscard]] bool has_changed() const { return factor_ > kChanged; }

 private:
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  Eigen::Array3d spread2_ = Eigen::Array3d::Zero();
  Eigen::Array3d speed2_ = Eigen::Array3d::Zero();
  double factor_ = 1.0;
};

}  // namespace prf_predictor
