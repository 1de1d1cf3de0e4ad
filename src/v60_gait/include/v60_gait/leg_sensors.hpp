// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>

#include "v60_gait/leg_controller.hpp"

namespace v60_gait {

/// Noise of encoders and inertial unit: white noise on angles and rates, and a first-order
/// Gauss-Markov error of the attitude (2 mrad, 10 s). All figures are chosen by hand. measure() is
/// to be called every `period`, s.
class LegSensors {
 public:
  LegSensors(std::uint64_t seed, double period);

  [[nodiscard]] LegObservation measure(LegObservation truth);

 private:
  [[nodiscard]] Eigen::Vector3d draw(double deviation);

  double period_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
  Eigen::Vector3d attitude_error_ = Eigen::Vector3d::Zero();  // rad
};

}  // namespace v60_gait
