// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/ukf.hpp"

#include <Eigen/Cholesky>

namespace prf_predictor {

Gaussian predict(const Gaussian& belief, const MotionModel& model, double dt,
                 const SigmaPointParams& params) {
  Gaussian predicted = unscented_transform(
      belief, params, [&](const Points& states) { return model.advance(states, dt); });
  predicted.covariance = repaired(predicted.covariance + model.process_noise(dt));
  return predicted;
}

Innovation innovate(const Gaussian& belief, const Eigen::Vector3d& position,
                    const Eigen::Matrix3d& covariance) {
  Innovation innovation;
  innovation.residual = position - belief.mean.head<3>();
  innovation.covariance = belief.covariance.topLeftCorner<3, 3>() + covariance;
  Eigen::LLT<Eigen::Matrix3d> factor(innovation.covariance);
  if (factor.info() != Eigen::Success) {
    innovation.covariance = repaired(innovation.covariance);
    factor.compute(innovation.covariance);
  }
  innovation.gain = factor.solve(belief.covariance.topRows<3>()).transpose();
  innovation.nis = innovation.residual.dot(factor.solve(innovation.residual));
  return innovation;
}

Gaussian correct(const Gaussian& belief, const Innovation& innovation) {
  Gaussian corrected = belief;
  const auto& K = innovation.gain;
  for (int i = 0; i < 3; ++i) corrected.mean += innovation.residual(i) * K.col(i);
  const decltype(innovation.gain) KS = K.lazyProduct(innovation.covariance);
  for (int i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < K.rows(); ++j) corrected.covariance.col(j) -= K(j, i) * KS.col(i);
  }
  corrected.covariance = repaired(corrected.covariance);
  return corrected;
}

}  // namespace prf_predictor
