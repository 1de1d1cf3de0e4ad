// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/kalman_predictor.hpp"

#include <utility>

#include <prf_core/require.hpp>
#include "prf_predictor/ekf.hpp"
#include "prf_predictor/ukf.hpp"

namespace prf_predictor {

using prf_core::require;

bool is_finite(const PointForecast& forecast) {
  return forecast.position.allFinite() && forecast.velocity.allFinite() &&
         forecast.covariance.allFinite();
}

KalmanPredictor::KalmanPredictor(std::shared_ptr<const MotionModel> model,
                                 const std::optional<SigmaPointParams>& sigma_points)
    : model_(std::move(model)), sigma_points_(sigma_points) {
  require(model_ != nullptr, "model", "null", "given");
  if (sigma_points_) sigma_points_->validate();
}

std::unique_ptr<TargetPredictor> KalmanPredictor::clone() const {
  return std::make_unique<KalmanPredictor>(*this);
}

void KalmanPredictor::begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) {
  belief_ = model_->initial_belief(position, covariance);
}

Gaussian KalmanPredictor::ahead(double dt) const {
  return sigma_points_ ? predict(belief_, *model_, dt, *sigma_points_)
                       : predict(belief_, *model_, dt);
}

void KalmanPredictor::advance(double dt) { belief_ = ahead(dt); }

void KalmanPredictor::correct(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) {
  belief_ = prf_predictor::correct(belief_, innovate(belief_, position, covariance));
}

Eigen::Vector3d KalmanPredictor::position(double horizon) const {
  return model_->advance(belief_.mean, horizon).col(0).head<3>();
}

PointForecast KalmanPredictor::forecast(double horizon) const {
  const Gaussian future = ahead(horizon);
  return {future.mean.head<3>(), future.mean.segment<3>(3),
          future.covariance.topLeftCorner<6, 6>()};
}

}  // namespace prf_predictor
