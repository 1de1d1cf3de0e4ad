// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/orientation_filter.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "prf_predictor/gaussian.hpp"

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

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1.0 : 1.0;
  const double half_sine = rotation.vec().norm();
  if (half_sine < 1e-12) return 2.0 * sign * rotation.vec();
  return 2.0 * sign * std::atan2(half_sine, sign * rotation.w()) / half_sine * rotation.vec();
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

OrientationBelief initial_orientation(const VelocityDecay& decay,
                                      const Eigen::Quaterniond& orientation,
                                      const Eigen::Matrix3d& covariance) {
  OrientationBelief belief;
  belief.orientation = orientation.normalized();
  belief.covariance.topLeftCorner<3, 3>() = covariance;
  belief.covariance.bottomRightCorner<3, 3>() =
      decay.prior_variance() * Eigen::Matrix3d::Identity();
  return belief;
}

OrientationBelief predict(const OrientationBelief& belief, const VelocityDecay& decay, double dt) {
  const double a = decay.velocity_factor(dt);
  const double b = decay.travel(dt);
  const Eigen::Vector3d turn = b * belief.rate;
  Eigen::Matrix<double, 6, 6> F = Eigen::Matrix<double, 6, 6>::Zero();
  F.topLeftCorner<3, 3>() = rotation_of(turn).toRotationMatrix();
  F.topRightCorner<3, 3>() = b * left_jacobian(turn);
  F.bottomRightCorner<3, 3>() = a * Eigen::Matrix3d::Identity();

  OrientationBelief predicted;
  predicted.orientation = (rotation_of(turn) * belief.orientation).normalized();
  predicted.rate = a * belief.rate;
  predicted.covariance =
      repaired(F * belief.covariance * F.transpose() + for_three_axes(decay.noise(dt)));
  return predicted;
}

OrientationInnovation innovate(const OrientationBelief& belief,
                               const Eigen::Quaterniond& orientation,
                               const Eigen::Matrix3d& covariance) {
  OrientationInnovation innovation;
  innovation.residual =
      rotation_vector((orientation * belief.orientation.conjugate()).normalized());
  innovation.covariance = repaired(belief.covariance.topLeftCorner<3, 3>() + covariance);
  const Eigen::LLT<Eigen::Matrix3d> factor(innovation.covariance);
  innovation.gain = factor.solve(belief.covariance.topRows<3>()).transpose();
  innovation.nis = innovation.residual.dot(factor.solve(innovation.residual));
  return innovation;
}

OrientationBelief correct(const OrientationBelief& belief,
                          const OrientationInnovation& innovation) {
  const Eigen::Matrix<double, 6, 1> correction = innovation.gain * innovation.residual;
  OrientationBelief corrected;
  corrected.orientation = (rotation_of(correction.head<3>()) * belief.orientation).normalized();
  corrected.rate = belief.rate + correction.tail<3>();
  corrected.covariance = repaired(belief.covariance - innovation.gain * innovation.covariance *
                                                          innovation.gain.transpose());
  return corrected;
}

}  // namespace prf_predictor
