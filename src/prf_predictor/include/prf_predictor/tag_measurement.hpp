// SPDX-License-Identifier: BSD-3-Clause
// One measurement of the target's pose, checked before a filter uses it.
//
// Covariances are of (x y z) and of the rotation vector about the axes of the frame the pose is
// given in: orientation_true = Exp(theta) orientation.
#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace prf_predictor {

struct TagMeasurement {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // unit
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d orientation_covariance = Eigen::Matrix3d::Zero();
};

// Used for a covariance that is zero, not finite, not symmetric or not positive definite.
struct MeasurementDefaults {
  double position_sigma = 0.0;     // m, > 0
  double orientation_sigma = 0.0;  // rad, > 0

  void validate() const;
};

enum class MeasurementStatus {
  kGood,
  kCovarianceReplaced,  // by the defaults
  kNotFinite,           // dropped
  kNoOrientation,       // dropped: the quaternion's norm is not 1 within 0.01
};

struct CheckedMeasurement {
  MeasurementStatus status = MeasurementStatus::kNotFinite;
  std::optional<TagMeasurement> measurement;  // nothing when dropped
};

[[nodiscard]] CheckedMeasurement check(const Eigen::Vector3d& position,
                                       const Eigen::Quaterniond& orientation,
                                       const Eigen::Matrix<double, 6, 6>& covariance,
                                       const MeasurementDefaults& defaults);

// The measurement in another frame; its covariances are rotated too.
[[nodiscard]] TagMeasurement operator*(const Eigen::Isometry3d& source_in_target,
                                       const TagMeasurement& measurement);

}  // namespace prf_predictor
