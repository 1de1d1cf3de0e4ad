// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/ukf.hpp"

#include <Eigen/Cholesky>

namespace prf_predictor {

Gaussian predict(const Gaussian& belief, const MotionModel& model, double dt,
                 const SigmaPointParams& params) {
  Gaussian predicted = unscented_transform(belief, params, [&](const Eigen::VectorXd& state) {
                         return model.advance(state, dt);
                       }).result;
  predicted.covariance = repaired(predicted.covariance + model.process_noise(dt));
  return predicted;
}

Innovation innovate(const Gaussian& belief, const Eigen::Vector3d& position,
                    const Eigen::Matrix3d& covariance, const SigmaPointParams& params) {
  const Transformed expected = unscented_transform(
      belief, params,
      [](const Eigen::VectorXd& state) -> Eigen::VectorXd { return state.head<3>(); });
  return innovation_of(expected.result, expected.cross_covariance, position, covariance);
}

Innovation innovation_of(const Gaussian& expected, const Eigen::MatrixXd& cross_covariance,
                         const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) {
  Innovation innovation;
  innovation.residual = position - expected.mean;
  innovation.covariance = repaired(expected.covariance + covariance);
  const Eigen::LLT<Eigen::MatrixXd> factor(innovation.covariance);
  innovation.gain = factor.solve(cross_covariance.transpose()).transpose();
  innovation.nis = innovation.residual.dot(factor.solve(innovation.residual));
  return innovation;
}

Gaussian correct(const Gaussian& belief, const Innovation& innovation) {
  return {belief.mean + innovation.gain * innovation.residual,
          repaired(belief.covariance -
                   innovation.gain * innovation.covariance * innovation.gain.transpose())};
}

}  // namespace prf_predictor
