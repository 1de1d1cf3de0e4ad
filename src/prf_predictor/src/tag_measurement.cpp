// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/tag_measurement.hpp"

#include <cmath>

#include <prf_core/require.hpp>
#include "prf_predictor/gaussian.hpp"

namespace prf_predictor {

namespace {

constexpr double kNormTolerance = 0.01;
constexpr double kLeastVariance = 1e-16;  // m^2, rad^2
constexpr double kMostVariance = 1e4;

bool is_unit(const Eigen::Quaterniond& orientation) {
  return std::abs(orientation.norm() - 1.0) <= kNormTolerance;
}

bool is_physical(const Eigen::Matrix<double, 6, 6>& covariance) {
  const auto variances = covariance.diagonal().array();
  return is_covariance(covariance) && (variances >= kLeastVariance).all() &&
         (variances <= kMostVariance).all();
}

}  // namespace

void MeasurementDefaults::validate() const {
  prf_core::require_between("position_sigma", position_sigma, 1e-6, 1.0, "m");
  prf_core::require_between("orientation_sigma", orientation_sigma, 1e-6, 1.0, "rad");
}

CheckedMeasurement check(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation,
                         const Eigen::Matrix<double, 6, 6>& covariance,
                         const MeasurementDefaults& defaults) {
  if (!position.allFinite() || !orientation.coeffs().allFinite()) {
    return {MeasurementStatus::kNotFinite, std::nullopt};
  }
  if (!(position.cwiseAbs().maxCoeff() <= kFarthestTag)) {
    return {MeasurementStatus::kTooFar, std::nullopt};
  }
  if (!is_unit(orientation)) return {MeasurementStatus::kNoOrientation, std::nullopt};
  TagMeasurement measurement{position,
                             orientation.normalized(),
                             covariance.topLeftCorner<3, 3>(),
                             covariance.bottomRightCorner<3, 3>(),
                             std::nullopt,
                             0.0};
  if (is_physical(covariance)) return {MeasurementStatus::kGood, measurement};

  measurement.position_covariance =
      std::pow(defaults.position_sigma, 2) * Eigen::Matrix3d::Identity();
  measurement.orientation_covariance =
      std::pow(defaults.orientation_sigma, 2) * Eigen::Matrix3d::Identity();
  return {MeasurementStatus::kCovarianceReplaced, measurement};
}

TagMeasurement with_alternative(TagMeasurement measurement, const Eigen::Quaterniond& alternative,
                                double ambiguity) {
  if (ambiguity > 0.0 && ambiguity <= 1.0 && is_unit(alternative)) {
    measurement.alternative = alternative.normalized();
    measurement.ambiguity = ambiguity;
  }
  return measurement;
}

TagMeasurement operator*(const Eigen::Isometry3d& source_in_target,
                         const TagMeasurement& measurement) {
  const Eigen::Matrix3d R = source_in_target.linear();
  TagMeasurement moved;
  moved.position = source_in_target * measurement.position;
  moved.orientation = (Eigen::Quaterniond(R) * measurement.orientation).normalized();
  if (measurement.alternative) {
    moved.alternative = (Eigen::Quaterniond(R) * *measurement.alternative).normalized();
    moved.ambiguity = measurement.ambiguity;
  }
  moved.position_covariance = R * measurement.position_covariance * R.transpose();
  moved.orientation_covariance = R * measurement.orientation_covariance * R.transpose();
  return moved;
}

}  // namespace prf_predictor
