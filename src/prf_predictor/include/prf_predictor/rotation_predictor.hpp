// SPDX-License-Identifier: BSD-3-Clause
// Predicts an orientation by any TargetPredictor, which gets rotation vectors p in place of
// positions (radians for metres):  R = Exp(p) R_0  with R_0 the orientation at the beginning. With
// J the left Jacobian of SO(3) at p, angular velocity and covariance in the planning frame are
//   w = J p',   P_R = J P J^T.
// A measurement farther than kFarthest from R_0 starts the prediction again, with R_0 there.
#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "prf_predictor/target_predictor.hpp"

namespace prf_predictor {

struct OrientationForecast {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // rad/s
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();        // of a rotation from the left, rad^2
};

[[nodiscard]] bool is_finite(const OrientationForecast& forecast);

class RotationPredictor {
 public:
  static constexpr double kFarthest = 1.5;  // rad

  // Starts from this measurement. Covariances are those of a rotation vector in the planning frame.
  RotationPredictor(const TargetPredictor& prototype, const Eigen::Quaterniond& orientation,
                    const Eigen::Matrix3d& covariance);
  RotationPredictor(const RotationPredictor& other);
  RotationPredictor& operator=(const RotationPredictor&) = delete;

  void advance(double dt);  // s, >= 0
  void correct(const Eigen::Quaterniond& orientation, const Eigen::Matrix3d& covariance);

  [[nodiscard]] OrientationForecast forecast(double horizon) const;  // s from now, >= 0

 private:
  Eigen::Quaterniond reference_;  // R_0
  std::unique_ptr<TargetPredictor> vectors_;
};

}  // namespace prf_predictor
