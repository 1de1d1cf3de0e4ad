// SPDX-License-Identifier: BSD-3-Clause
// Extended Kalman filter of a moving point whose position is measured, as pure functions beside
// those of ukf.hpp:
//   predict:   m <- f(m),  P <- F P F^T + Q with F the Jacobian of f at m
//   innovate:  nu = z - m_position, S = P_position + R, K = P_{.,position} S^-1.
#pragma once

#include "prf_predictor/ukf.hpp"

namespace prf_predictor {

[[nodiscard]] Gaussian predict(const Gaussian& belief, const MotionModel& model, double dt);

[[nodiscard]] Innovation innovate(const Gaussian& belief, const Eigen::Vector3d& position,
                                  const Eigen::Matrix3d& covariance);

}  // namespace prf_predictor
