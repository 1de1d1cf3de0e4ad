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
  // The second orientation that explains the tag's corners, if any, and the reprojection error of
  // the first divided by that of the second.
  std::optional<Eigen::Quaterniond> alternative;  // unit
  double ambiguity = 0.0;                         // 0 .. 1
};

// Used for a covariance that is zero, not finite, not symmetric, not positive definite or out of
// all physical bounds.
struct MeasurementDefaults {
  double position_sigma = 0.0;     // m, 1e-6 .. 1
  double orientation_sigma = 0.0;  // rad, 1e-6 .. 1

  void validate() const;
};

enum class MeasurementStatus {
  kGood,
  kCovarianceReplaced,  // by the defaults
  kNotFinite,           // dropped
  kTooFar,              // dropped: beyond kFarthestTag from the camera
  kNoOrientation,       // dropped: the quaternion's norm is not 1 within 0.01
};

struct CheckedMeasurement {
  MeasurementStatus status = MeasurementStatus::kNotFinite;
  std::optional<TagMeasurement> measurement;  // nothing when dropped
};

inline constexpr double kFarthestTag = 1000.0;  // m

[[nodiscard]] CheckedMeasurement check(const Eigen::Vector3d& position,
                                       const Eigen::Quaterniond& orientation,
                                       const Eigen::Matrix<double, 6, 6>& covariance,
                                       const MeasurementDefaults& defaults);

// With a second orientation when it is a unit quaternion and its ambiguity is in (0, 1].
[[nodiscard]] TagMeasurement with_alternative(TagMeasurement measurement,
                                              const Eigen::Quaterniond& alternative,
                                              double ambiguity);

// The measurement in another frame; its covariances are rotated too.
[[nodiscard]] TagMeasurement operator*(const Eigen::Isometry3d& source_in_target,
                                       const TagMeasurement& measurement);

}  // namespace prf_predictor
