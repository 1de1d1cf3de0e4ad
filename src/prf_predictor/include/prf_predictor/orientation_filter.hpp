// SPDX-License-Identifier: BSD-3-Clause
// Orientation and angular velocity of a target: a multiplicative error-state Kalman filter.
//
// Belief: R, w and the covariance of the error (theta, d) with  R_true = Exp(theta) R and
// w_true = w + d, all in the planning frame. The angular velocity keeps its direction and decays
// as VelocityDecay says, so with b = travel, a = velocity_factor and J the left Jacobian of SO(3):
//   R <- Exp(b w) R,  w <- a w
//   F = [[Exp(b w), b J(b w)], [0, a I]].
#pragma once

#include <Eigen/Geometry>

#include "prf_predictor/motion_model.hpp"

namespace prf_predictor {

struct OrientationBelief {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();                                // rad/s
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  // rad, rad/s
};

[[nodiscard]] OrientationBelief initial_orientation(const VelocityDecay& decay,
                                                    const Eigen::Quaterniond& orientation,
                                                    const Eigen::Matrix3d& covariance);

[[nodiscard]] OrientationBelief predict(const OrientationBelief& belief, const VelocityDecay& decay,
                                        double dt);

struct OrientationInnovation {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();  // Log(R_measured R^T)
  Eigen::Matrix<double, 6, 3> gain = Eigen::Matrix<double, 6, 3>::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double nis = 0.0;
};

// `covariance`: of the measured rotation vector in the planning frame.
[[nodiscard]] OrientationInnovation innovate(const OrientationBelief& belief,
                                             const Eigen::Quaterniond& orientation,
                                             const Eigen::Matrix3d& covariance);

[[nodiscard]] OrientationBelief correct(const OrientationBelief& belief,
                                        const OrientationInnovation& innovation);

// Rotation vector of a unit quaternion, the shorter way round, and back.
[[nodiscard]] Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation);
[[nodiscard]] Eigen::Quaterniond rotation_of(const Eigen::Vector3d& rotation_vector);

}  // namespace prf_predictor
