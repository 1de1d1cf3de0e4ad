// SPDX-License-Identifier: BSD-3-Clause
// Foretells an orientation with any TargetPredictor, which is given rotation vectors p in place of
// positions, radians for metres:  R = Exp(p) R_0  with R_0 the orientation at the beginning. With J
// the left Jacobian of SO(3) at p, angular velocity and covariance in the planning frame are
//   w = J p',   P_R = J P J^T.
// A target that is seen farther than kFarthest from R_0 begins anew there.
#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "prf_predictor/target_predictor.hpp"

namespace prf_predictor {

struct OrientationForecast {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();        // rad/s
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of a rotation from the left, rad^2
};

[[nodiscard]] bool is_finite(const OrientationForecast& forecast);

class RotationPredictor {
 public:
  static constexpr double kFarthest = 1.5;  // rad

  // Seen so, now. Covariances are those of a rotation vector in the planning frame.
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

// Rotation vector of a unit quaternion, the shorter way round, and back.
[[nodiscard]] Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& rotation);
[[nodiscard]] Eigen::Quaterniond rotation_of(const Eigen::Vector3d& rotation_vector);

}  // namespace prf_predictor
