// SPDX-License-Identifier: BSD-3-Clause
// A motion model and a Kalman filter, chosen apart, as a predictor.
#pragma once

#include <memory>
#include <optional>

#include "prf_predictor/motion_model.hpp"
#include "prf_predictor/target_predictor.hpp"
#include "prf_predictor/unscented_transform.hpp"

namespace prf_predictor {

class KalmanPredictor : public TargetPredictor {
 public:
  // With sigma points the filter is the unscented one, without the extended one.
  KalmanPredictor(std::shared_ptr<const MotionModel> model,
                  const std::optional<SigmaPointParams>& sigma_points);

  [[nodiscard]] std::unique_ptr<TargetPredictor> clone() const override;
  void begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) override;
  void advance(double dt) override;
  void correct(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) override;
  [[nodiscard]] PointForecast forecast(double horizon) const override;

  // The mean position alone, of the model through the mean.
  [[nodiscard]] Eigen::Vector3d position(double horizon) const;

  [[nodiscard]] const Gaussian& belief() const { return belief_; }

 private:
  [[nodiscard]] Gaussian ahead(double dt) const;

  std::shared_ptr<const MotionModel> model_;
  std::optional<SigmaPointParams> sigma_points_;
  Gaussian belief_;
};

}  // namespace prf_predictor
