// SPDX-License-Identifier: BSD-3-Clause
// Prediction of the extended Kalman filter, beside that of ukf.hpp; the rest is the same.
//   m <- f(m),  P <- F P F^T + Q with F the Jacobian of f at m.
#pragma once

#include "prf_predictor/motion_model.hpp"

namespace prf_predictor {

[[nodiscard]] Gaussian predict(const Gaussian& belief, const MotionModel& model, double dt);

}  // namespace prf_predictor
