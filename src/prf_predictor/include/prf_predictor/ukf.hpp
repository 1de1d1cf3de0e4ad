// SPDX-License-Identifier: BSD-3-Clause
// Unscented Kalman filter of a moving point whose position is measured, as pure functions:
//   predict:   m, P <- UT(advance), P += Q
//   innovate:  S = P_position + R, nu = z - m_position, NIS = nu^T S^-1 nu
//   correct:   K = P_{.,position} S^-1, m += K nu, P -= K S K^T.
// The position is a linear function of the state, of which the unscented transform gives
// m_position, P_position and P_{.,position} exactly, whatever its parameters: it need not be
// carried out. On a linear model all of this is the Kalman filter. Covariances returned are
// symmetric and positive definite.
#pragma once

#include "prf_predictor/motion_model.hpp"
#include "prf_predictor/unscented_transform.hpp"

namespace prf_predictor {

[[nodiscard]] Gaussian predict(const Gaussian& belief, const MotionModel& model, double dt,
                               const SigmaPointParams& params);

struct Innovation {
  Eigen::Vector3d residual;                                          // nu
  Eigen::Matrix3d covariance;                                        // S
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMostStates, 3> gain;  // K
  double nis = 0.0;
};

[[nodiscard]] Innovation innovate(const Gaussian& belief, const Eigen::Vector3d& position,
                                  const Eigen::Matrix3d& covariance);

[[nodiscard]] Gaussian correct(const Gaussian& belief, const Innovation& innovation);

}  // namespace prf_predictor
