// SPDX-License-Identifier: BSD-3-Clause
// The forecast of the target: where it is and will be at several horizons, in the planning frame
// (base of the arm). Metres, seconds, radians.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "prf_core/se3.hpp"
#include "prf_core/time.hpp"

namespace prf_core {

// As in prf_msgs/TargetForecast.
enum class TargetStatus {
  kNoTarget,  // no measurement yet in this run
  kTracking,  // recent measurements were accepted
  kCoasting,  // predicted without accepted measurements
  kLost       // coasted for too long; the predictions must not be used
};

struct TargetPrediction {
  Duration horizon{0};  // from the forecast's stamp
  MovingPose target;
  // Of (position, linear velocity): m^2, m^2/s, m^2/s^2. The orientation has no covariance.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  [[nodiscard]] Eigen::Matrix3d position_covariance() const {
    return covariance.topLeftCorner<3, 3>();
  }
};

// What the latest measured positions alone say of the motion, as in prf_msgs/TargetForecast.
struct MeasuredMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();             // m/s
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  // zero: no measured velocity
  double speed = 0.0;  // m/s, >= 0, root mean square over the last 0.25 s, less the noise

  [[nodiscard]] bool has_velocity() const { return velocity_covariance.trace() > 0.0; }
};

struct TargetForecast {
  Stamp stamp{0};
  TargetStatus status = TargetStatus::kNoTarget;
  Duration since_measurement{0};              // at the stamp, since the last accepted measurement
  std::vector<TargetPrediction> predictions;  // horizons rise strictly from 0
  MeasuredMotion measured_motion;

  // Demands a usable stamp and values within the bounds of bounds.hpp, unit quaternions
  // (kUnitQuaternionTolerance), horizons that rise from 0, since_measurement >= 0, and at least one
  // prediction while tracking or coasting. Whether the covariance is positive definite is not
  // checked. Throws std::invalid_argument naming the member, its value and the bound.
  void validate() const;
};

// Predicts the target at `stamp`; the result's horizon is stamp - forecast.stamp. Between two
// predictions the pose and velocity are those of interpolate(), and the covariance is linear.
// Before the first and beyond the last horizon the result has that prediction's pose and
// covariance, with zero velocity. Throws std::invalid_argument when there are no predictions.
[[nodiscard]] TargetPrediction predicted_target(const TargetForecast& forecast, Stamp stamp);

}  // namespace prf_core
