// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/tag_measurement.hpp"

#include <cmath>

#include <prf_core/require.hpp>
#include "prf_predictor/gaussian.hpp"

namespace prf_predictor {

using prf_core::require;
namespace {

constexpr double kNormTolerance = 0.01;

}  // namespace

void MeasurementDefaults::validate() const {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  require(positive(position_sigma), "position_sigma", position_sigma, "finite and > 0 m");
  require(positive(orientation_sigma), "orientation_sigma", orientation_sigma,
          "finite and > 0 rad");
}

CheckedMeasurement check(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation,
                         const Eigen::Matrix<double, 6, 6>& covariance,
                         const MeasurementDefaults& defaults) {
  if (!position.allFinite() || !orientation.coeffs().allFinite()) {
    return {MeasurementStatus::kNotFinite, std::nullopt};
  }
  if (!(std::abs(orientation.norm() - 1.0) <= kNormTolerance)) {
    return {MeasurementStatus::kNoOrientation, std::nullopt};
  }
  TagMeasurement measurement{position, orientation.normalized(), covariance.topLeftCorner<3, 3>(),
                             covariance.bottomRightCorner<3, 3>()};
  if (is_covariance(covariance)) return {MeasurementStatus::kGood, measurement};

  measurement.position_covariance =
      std::pow(defaults.position_sigma, 2) * Eigen::Matrix3d::Identity();
  measurement.orientation_covariance =
      std::pow(defaults.orientation_sigma, 2) * Eigen::Matrix3d::Identity();
  return {MeasurementStatus::kCovarianceReplaced, measurement};
}

TagMeasurement operator*(const Eigen::Isometry3d& source_in_target,
                         const TagMeasurement& measurement) {
  const Eigen::Matrix3d R = source_in_target.linear();
  TagMeasurement moved;
  moved.position = source_in_target * measurement.position;
  moved.orientation = (Eigen::Quaterniond(R) * measurement.orientation).normalized();
  moved.position_covariance = R * measurement.position_covariance * R.transpose();
  moved.orientation_covariance = R * measurement.orientation_covariance * R.transpose();
  return moved;
}

}  // namespace prf_predictor
