// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>

#include "v60_gait/leg_controller.hpp"

namespace v60_gait {

/// What encoders and inertial unit make of the truth: white noise, and an attitude that is off by
/// a slowly wandering turn (first-order Gauss-Markov). To be called every `period`, s.
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
