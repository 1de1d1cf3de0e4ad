// SPDX-License-Identifier: BSD-3-Clause
// How a target moves between two looks at it: the model is a value apart from the filter.
//
// A state starts with position and velocity (6 numbers, m and m/s, in the planning frame); a model
// may append more.
#pragma once

#include <Eigen/Core>
#include <string>

namespace prf_predictor {

class MotionModel {
 public:
  virtual ~MotionModel() = default;

  [[nodiscard]] virtual Eigen::Index dimension() const = 0;
  [[nodiscard]] virtual Eigen::VectorXd advance(const Eigen::VectorXd& state, double dt) const = 0;
  [[nodiscard]] virtual Eigen::MatrixXd process_noise(double dt) const = 0;
  // Covariance of what one position does not tell: all of the state but its position.
  [[nodiscard]] virtual Eigen::MatrixXd prior_covariance() const = 0;
};

// White-noise acceleration w of spectral density q on a velocity that decays with the time
// constant T:  p' = v,  v' = -v / T + w. An infinite T is the constant-velocity model.
// With a = exp(-dt / T) and b = T (1 - a), exactly and per axis:
//   p += b v,  v *= a
//   Q = q [[T^2 (dt - 2 b + T (1 - a^2) / 2), b^2 / 2], [b^2 / 2, T (1 - a^2) / 2]].
struct VelocityDecay {
  double spectral_density = 0.0;  // q, (m/s^2)^2 / Hz, > 0; of angles (rad/s^2)^2 / Hz
  double time_constant = 0.0;     // T, s, > 0, may be infinite

  [[nodiscard]] double velocity_factor(double dt) const;  // a
  [[nodiscard]] double travel(double dt) const;           // b, s
  [[nodiscard]] Eigen::Matrix2d noise(double dt) const;   // Q
  // Of the velocity before anything is known: the stationary one, at most 1.
  [[nodiscard]] double prior_variance() const;
};

// Throws std::invalid_argument naming the value and its bound; `density` is the density's name.
void validate(const VelocityDecay& decay, const std::string& density);

class DecayingVelocity : public MotionModel {
 public:
  explicit DecayingVelocity(const VelocityDecay& decay);

  [[nodiscard]] Eigen::Index dimension() const override { return 6; }
  [[nodiscard]] Eigen::VectorXd advance(const Eigen::VectorXd& state, double dt) const override;
  [[nodiscard]] Eigen::MatrixXd process_noise(double dt) const override;
  [[nodiscard]] Eigen::MatrixXd prior_covariance() const override;

 private:
  VelocityDecay decay_;
};

// Q of every axis, for three axes: (x y z, vx vy vz).
[[nodiscard]] Eigen::Matrix<double, 6, 6> for_three_axes(const Eigen::Matrix2d& noise);

}  // namespace prf_predictor
