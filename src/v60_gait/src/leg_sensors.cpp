// SPDX-License-Identifier: BSD-3-Clause
#include "v60_gait/leg_sensors.hpp"

#include <cmath>
#include <prf_core/se3.hpp>

namespace v60_gait {
namespace {

// Chosen by hand; no data sheet was used.
constexpr double kAngleNoise = 1e-4;      // rad, of a joint
constexpr double kRateNoise = 3e-3;       // rad/s, of a joint
constexpr double kGyroNoise = 1.5e-3;     // rad/s
constexpr double kAttitudeError = 2e-3;   // rad
constexpr double kAttitudeMemory = 10.0;  // s

}  // namespace

LegSensors::LegSensors(std::uint64_t seed, double period) : period_(period), generator_(seed) {}

Eigen::Vector3d LegSensors::draw(double deviation) {
  Eigen::Vector3d vector;
  for (Eigen::Index i = 0; i < 3; ++i) vector[i] = deviation * normal_(generator_);
  return vector;
}

LegObservation LegSensors::measure(LegObservation truth) {
  for (Eigen::Index leg = 0; leg < 4; ++leg) {
    truth.positions.segment<3>(3 * leg) += draw(kAngleNoise);
    truth.velocities.segment<3>(3 * leg) += draw(kRateNoise);
  }
  truth.angular_velocity += draw(kGyroNoise);
  const double forgotten = period_ / kAttitudeMemory;
  attitude_error_ += -forgotten * attitude_error_ + draw(kAttitudeError * std::sqrt(2 * forgotten));
  truth.attitude = truth.attitude * prf_core::exp_so3(attitude_error_);
  return truth;
}

}  // namespace v60_gait
