// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/ukf.hpp"

#include <Eigen/Cholesky>

namespace prf_predictor {

Gaussian initial_belief(const MotionModel& model, const Eigen::Vector3d& position,
                        const Eigen::Matrix3d& covariance) {
  const Eigen::Index n = model.dimension();
  Gaussian belief{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  belief.mean.head<3>() = position;
  belief.covariance.topLeftCorner<3, 3>() = covariance;
  belief.covariance.bottomRightCorner(n - 3, n - 3) = model.prior_covariance();
  return belief;
}

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
  Innovation innovation;
  innovation.residual = position - expected.result.mean;
  innovation.covariance = repaired(expected.result.covariance + covariance);
  const Eigen::LLT<Eigen::MatrixXd> factor(innovation.covariance);
  innovation.gain = factor.solve(expected.cross_covariance.transpose()).transpose();
  innovation.nis = innovation.residual.dot(factor.solve(innovation.residual));
  return innovation;
}

Gaussian correct(const Gaussian& belief, const Innovation& innovation) {
  return {belief.mean + innovation.gain * innovation.residual,
          repaired(belief.covariance -
                   innovation.gain * innovation.covariance * innovation.gain.transpose())};
}

}  // namespace prf_predictor
