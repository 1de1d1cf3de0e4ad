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
enum class TargetStatus { kNoTarget, kTracking, kCoasting, kLost };

struct TargetPrediction {
  Duration horizon{0};  // from the forecast's stamp
  MovingPose target;
  // Of (position, velocity): m^2, m^2/s, m^2/s^2.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  [[nodiscard]] Eigen::Matrix3d position_covariance() const {
    return covariance.topLeftCorner<3, 3>();
  }
};

struct TargetForecast {
  Stamp stamp{0};
  TargetStatus status = TargetStatus::kNoTarget;
  Duration since_measurement{0};              // at the stamp, since the last accepted measurement
  std::vector<TargetPrediction> predictions;  // horizons rise strictly from 0

  // Finite values, unit quaternions (kUnitQuaternionTolerance), horizons that rise from 0, at
  // least one prediction while tracking or coasting. Throws std::invalid_argument naming the
  // member, its value and the bound.
  void validate() const;
};

// The target `stamp - forecast.stamp` ahead: interpolate() between the neighbouring predictions,
// their covariance linearly. Before the first and beyond the last horizon the target is held at
// that prediction, at rest. Throws std::invalid_argument when there are no predictions.
[[nodiscard]] TargetPrediction predicted_target(const TargetForecast& forecast, Stamp stamp);

}  // namespace prf_core
