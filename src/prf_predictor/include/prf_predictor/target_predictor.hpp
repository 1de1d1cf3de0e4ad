// SPDX-License-Identifier: BSD-3-Clause
// What every way of foretelling a point's path has in common: it is told positions with their
// covariance in the order of time and says where the point will be.
//
// A predictor is a value: copies (clone) share nothing that changes. Its answers depend on the
// calls alone.
#pragma once

#include <Eigen/Core>
#include <memory>

namespace prf_predictor {

struct PointForecast {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  // of both
};

[[nodiscard]] bool is_finite(const PointForecast& forecast);

class TargetPredictor {
 public:
  virtual ~TargetPredictor() = default;

  [[nodiscard]] virtual std::unique_ptr<TargetPredictor> clone() const = 0;

  // Forgets everything; the point is seen here, now. To be called before all else.
  virtual void begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) = 0;
  // Time passes, dt >= 0 s.
  virtual void advance(double dt) = 0;
  // The point is seen here, now.
  virtual void correct(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) = 0;

  [[nodiscard]] virtual PointForecast forecast(double horizon) const = 0;  // s from now, >= 0

 protected:
  TargetPredictor() = default;
  TargetPredictor(const TargetPredictor&) = default;
  TargetPredictor& operator=(const TargetPredictor&) = default;
};

}  // namespace prf_predictor
