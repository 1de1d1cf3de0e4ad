// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/ekf.hpp"

namespace prf_predictor {

Gaussian predict(const Gaussian& belief, const MotionModel& model, double dt) {
  const StateMatrix F = model.jacobian(belief.mean, dt);
  return {model.advance(belief.mean, dt),
          repaired(F.lazyProduct(belief.covariance).eval().lazyProduct(F.transpose()) +
                   model.process_noise(dt))};
}

}  // namespace prf_predictor
