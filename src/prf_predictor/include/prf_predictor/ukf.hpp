// SPDX-License-Identifier: BSD-3-Clause
// Unscented Kalman filter of a moving point whose position is measured, as pure functions:
//   predict:   m, P <- UT(advance), P += Q
//   innovate:  z_hat, S, C = UT(position), S += R, nu = z - z_hat, NIS = nu^T S^-1 nu
//   correct:   K = C S^-1, m += K nu, P -= K S K^T.
// On a linear model this is the Kalman filter. Covariances returned are symmetric and positive
// definite.
#pragma once

#include "prf_predictor/motion_model.hpp"
#include "prf_predictor/unscented_transform.hpp"

namespace prf_predictor {

[[nodiscard]] Gaussian predict(const Gaussian& belief, const MotionModel& model, double dt,
                               const SigmaPointParams& params);

struct Innovation {
  Eigen::VectorXd residual;    // nu
  Eigen::MatrixXd covariance;  // S
  Eigen::MatrixXd gain;        // K
  double nis = 0.0;
};

[[nodiscard]] Innovation innovate(const Gaussian& belief, const Eigen::Vector3d& position,
                                  const Eigen::Matrix3d& covariance,
                                  const SigmaPointParams& params);

// The same once the expected measurement and its covariance with the state (n x 3) are known.
[[nodiscard]] Innovation innovation_of(const Gaussian& expected,
                                       const Eigen::MatrixXd& cross_covariance,
                                       const Eigen::Vector3d& position,
                                       const Eigen::Matrix3d& covariance);

[[nodiscard]] Gaussian correct(const Gaussian& belief, const Innovation& innovation);

}  // namespace prf_predictor
