// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/rotation_predictor.hpp"

#include <Eigen/LU>
#include <cmath>
#include <prf_core/se3.hpp>

namespace prf_predictor {
namespace {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  return (Eigen::Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

// J(v) = I + (1 - cos t) / t^2 [v] + (t - sin t) / t^3 [v]^2 with t = |v|.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& v) {
  const double t = v.norm();
  const Eigen::Matrix3d V = skew(v);
  if (t < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * V + V * V / 6.0;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(t)) / (t * t) * V +
         (t - std::sin(t)) / (t * t * t) * V * V;
}

}  // namespace

bool is_finite(const OrientationForecast& forecast) {
  return forecast.orientation.coeffs().allFinite() && forecast.angular_velocity.allFinite() &&
         forecast.covariance.allFinite();
}

RotationPredictor::RotationPredictor(const TargetPredictor& prototype,
                                     const Eigen::Quaterniond& orientation,
                                     const Eigen::Matrix3d& covariance)
    : reference_(orientation.normalized()), vectors_(prototype.clone()) {
  vectors_->begin(Eigen::Vector3d::Zero(), covariance);
}

RotationPredictor::RotationPredictor(const RotationPredictor& other)
    : reference_(other.reference_), vectors_(other.vectors_->clone()) {}

void RotationPredictor::advance(double dt) { vectors_->advance(dt); }

void RotationPredictor::correct(const Eigen::Quaterniond& orientation,
                                const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d measured =
      prf_core::log_so3((orientation * reference_.conjugate()).normalized());
  if (measured.norm() > kFarthest) {
    reference_ = orientation.normalized();
    vectors_->begin(Eigen::Vector3d::Zero(), covariance);
    return;
  }
  const Eigen::Matrix3d inverse = left_jacobian(measured).inverse();
  vectors_->correct(measured, inverse * covariance * inverse.transpose());
}

OrientationForecast RotationPredictor::forecast(double horizon) const {
  const PointForecast vector = vectors_->forecast(horizon);
  const Eigen::Matrix3d J = left_jacobian(vector.position);
  return {(Eigen::Quaterniond(prf_core::exp_so3(vector.position)) * reference_).normalized(),
          J * vector.velocity, J * vector.covariance.topLeftCorner<3, 3>() * J.transpose()};
}

}  // namespace prf_predictor
