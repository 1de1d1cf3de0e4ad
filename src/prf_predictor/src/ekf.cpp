// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/ekf.hpp"

namespace prf_predictor {

Gaussian predict(const Gaussian& belief, const MotionModel& model, double dt) {
  const Eigen::MatrixXd F = model.jacobian(belief.mean, dt);
  return {model.advance(belief.mean, dt),
          repaired(F * belief.covariance * F.transpose() + model.process_noise(dt))};
}

Innovation innovate(const Gaussian& belief, const Eigen::Vector3d& position,
                    const Eigen::Matrix3d& covariance) {
  return innovation_of({belief.mean.head<3>(), belief.covariance.topLeftCorner<3, 3>()},
                       belief.covariance.leftCols<3>(), position, covariance);
}

}  // namespace prf_predictor
