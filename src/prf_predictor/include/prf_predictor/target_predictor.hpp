// SPDX-License-Identifier: BSD-3-Clause
// The interface of every predictor of a moving point. The caller gives it measured positions with
// their covariance in the order of time, and asks where the point will be.
//
// A predictor is a value: a clone shares nothing with it that changes. Results depend on the calls
// alone, not on the machine's clock.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

namespace prf_predictor {

struct PointForecast {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  // of both
};

[[nodiscard]] bool is_finite(const PointForecast& forecast);

// What a predictor knows of a periodic motion.
struct Periodicity {
  double probability = 0.0;         // that the motion is periodic, of the models that tell
  std::vector<double> frequencies;  // of the most probable periodic hypothesis, rad/s
};

class TargetPredictor {
 public:
  virtual ~TargetPredictor() = default;

  [[nodiscard]] virtual std::unique_ptr<TargetPredictor> clone() const = 0;

  // Forgets everything and starts from this measurement. The first call.
  virtual void begin(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) = 0;
  // Time passes, dt >= 0 s.
  virtual void advance(double dt) = 0;
  // A measurement at the present time.
  virtual void correct(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance) = 0;

  [[nodiscard]] virtual PointForecast forecast(double horizon) const = 0;  // s from now, >= 0

  // As far as it matters for a prediction at this horizon; nothing: the predictor does not ask.
  [[nodiscard]] virtual std::optional<Periodicity> periodicity(double /*horizon*/) const {
    return std::nullopt;
  }

 protected:
  TargetPredictor() = default;
  TargetPredictor(const TargetPredictor&) = default;
  TargetPredictor& operator=(const TargetPredictor&) = default;
};

}  // namespace prf_predictor
