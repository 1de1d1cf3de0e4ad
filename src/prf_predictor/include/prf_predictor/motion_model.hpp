// SPDX-License-Identifier: BSD-3-Clause
// How a target moves between two measurements. The model is a value apart from the filter.
//
// A state starts with position and velocity (6 numbers, m and m/s, in the planning frame); a model
// may append more.
#pragma once

#include <Eigen/Core>

#include "prf_predictor/unscented_transform.hpp"

namespace prf_predictor {

class MotionModel {
 public:
  virtual ~MotionModel() = default;

  [[nodiscard]] virtual Eigen::Index dimension() const = 0;
  // Of states side by side, one a column.
  [[nodiscard]] virtual Points advance(const Points& states, double dt) const = 0;
  [[nodiscard]] virtual StateMatrix process_noise(double dt) const = 0;
  // Of advance, by the state.
  [[nodiscard]] virtual StateMatrix jacobian(const State& state, double dt) const = 0;
  // Position known by a measurement, the rest by the model's prior.
  [[nodiscard]] virtual Gaussian initial_belief(const Eigen::Vector3d& position,
                                                const Eigen::Matrix3d& covariance) const = 0;
};

// White-noise acceleration w of spectral density q on a velocity that decays with the time
// constant T:  p' = v,  v' = -v / T + w. An infinite T is the constant-velocity model.
// With a = exp(-dt / T) and b = T (1 - a), exactly and per axis:
//   p += b v,  v *= a
//   Q = q [[T^2 (dt - 2 b + T (1 - a^2) / 2), b^2 / 2], [b^2 / 2, T (1 - a^2) / 2]].
struct VelocityDecay {
  double spectral_density = 0.0;  // q, (m/s^2)^2 / Hz, > 0
  double time_constant = 0.0;     // T, s, > 0, may be infinite

  [[nodiscard]] double velocity_factor(double dt) const;  // a
  [[nodiscard]] double travel(double dt) const;           // b, s
  [[nodiscard]] Eigen::Matrix2d noise(double dt) const;   // Q
  // Of the velocity before anything is known: the stationary one, at most 1.
  [[nodiscard]] double prior_variance() const;

  void validate() const;
};

class DecayingVelocity : public MotionModel {
 public:
  explicit DecayingVelocity(const VelocityDecay& decay);

  [[nodiscard]] Eigen::Index dimension() const override { return 6; }
  [[nodiscard]] Points advance(const Points& states, double dt) const override;
  [[nodiscard]] StateMatrix process_noise(double dt) const override;
  [[nodiscard]] StateMatrix jacobian(const State& state, double dt) const override;
  [[nodiscard]] Gaussian initial_belief(const Eigen::Vector3d& position,
                                        const Eigen::Matrix3d& covariance) const override;

 private:
  VelocityDecay decay_;
};

// White-noise jerk of the spectral density q on the acceleration: p' = v, v' = a, a' = w; nine
// numbers (p v a).
class ConstantAcceleration : public MotionModel {
 public:
  explicit ConstantAcceleration(double jerk_density);  // q, (m/s^3)^2 / Hz, > 0

  [[nodiscard]] Eigen::Index dimension() const override { return 9; }
  [[nodiscard]] Points advance(const Points& states, double dt) const override;
  [[nodiscard]] StateMatrix process_noise(double dt) const override;
  [[nodiscard]] StateMatrix jacobian(const State& state, double dt) const override;
  [[nodiscard]] Gaussian initial_belief(const Eigen::Vector3d& position,
                                        const Eigen::Matrix3d& covariance) const override;

 private:
  double jerk_density_;
};

// An oscillation about a centre, of an unknown frequency common to the axes: p'' = -W^2 (p - c) +
// w; ten numbers (p v c ln W). Centre and ln W drift like random walks. Not linear.
struct OscillationNoise {
  double acceleration_density = 0.0;  // of w, (m/s^2)^2 / Hz, > 0
  double centre_density = 0.0;        // of c', (m/s)^2 / Hz, > 0
  double frequency_density = 0.0;     // of (ln W)', 1 / s, > 0
};

class Oscillation : public MotionModel {
 public:
  static constexpr Eigen::Index kLogFrequency = 9;  // of ln W in the state

  explicit Oscillation(const OscillationNoise& noise);

  [[nodiscard]] Eigen::Index dimension() const override { return 10; }
  [[nodiscard]] Points advance(const Points& states, double dt) const override;
  [[nodiscard]] StateMatrix process_noise(double dt) const override;
  [[nodiscard]] StateMatrix jacobian(const State& state, double dt) const override;
  [[nodiscard]] Gaussian initial_belief(const Eigen::Vector3d& position,
                                        const Eigen::Matrix3d& covariance) const override;

 private:
  OscillationNoise noise_;
};

// Q of every axis, for three axes: (x y z, vx vy vz).
[[nodiscard]] Eigen::Matrix<double, 6, 6> for_three_axes(const Eigen::Matrix2d& noise);

}  // namespace prf_predictor
