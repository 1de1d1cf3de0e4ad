// SPDX-License-Identifier: BSD-3-Clause
// A position as the sum of independent components, and the Kalman filter of that linear model. Each
// component has two numbers of state per axis, of which the first is its contribution to the
// position:
//   drift                VelocityDecay: position and velocity of slow, unbounded motion
//   damped oscillator    x'' = -2 z W x' - W^2 x + w
// W is the angular frequency, z the damping ratio and w white noise such that the stationary
// standard deviation of x is s. A small z is a narrow line in the spectrum, whose phase is
// remembered for about 1 / (z W); z near 1 is a random motion that returns to 0.
//
// With the stationary covariance S = diag(s^2, s^2 W^2), F = exp(A dt) and Q = S - F S F^T exactly.
//
// The measurement noise is taken as the same for the three axes (the mean of their variances), so
// that they share covariance and gain.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prf_predictor/motion_model.hpp"

namespace prf_predictor {

struct DampedOscillator {
  double frequency = 0.0;      // W, rad/s, > 0
  double damping_ratio = 0.0;  // z, > 0 and < 1
  double sigma = 0.0;          // s, m, > 0
};

struct Transition {
  Eigen::Matrix2d F;
  Eigen::Matrix2d Q;
};

[[nodiscard]] Transition transition(const VelocityDecay& drift, double dt);
[[nodiscard]] Transition transition(const DampedOscillator& oscillator, double dt);

// A drift, which is component 0, and oscillators, from which models choose.
struct Components {
  VelocityDecay drift;
  std::vector<DampedOscillator> oscillators;

  [[nodiscard]] std::vector<Transition> transitions(double dt) const;
};

// The belief of one model, which is the sum of some of the components, given by their numbers.
class SpectralBelief {
 public:
  static constexpr int kMostComponents = 5;

  struct Forecast {
    Eigen::Vector3d position;
    Eigen::Vector3d velocity;
    Eigen::Matrix2d covariance;  // of position and velocity, for each axis
  };

  SpectralBelief(const Components& components, std::shared_ptr<const std::vector<int>> used,
                 const Eigen::Vector3d& position, double variance);

  // What is not measured of the components becomes as uncertain as at first; means stay.
  void unsettle(const Components& components, double variance);
  void advance(const std::vector<Transition>& transitions);
  void correct(const Eigen::Vector3d& position, double variance);
  [[nodiscard]] Forecast forecast(const std::vector<Transition>& transitions) const;
  // The position alone.
  [[nodiscard]] Eigen::Vector3d position(const std::vector<Transition>& transitions) const;
  [[nodiscard]] Eigen::MatrixXd covariance() const { return P_; }

 private:
  static constexpr int kMost = 2 * kMostComponents;
  using State = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMost, 3>;
  using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;

  std::shared_ptr<const std::vector<int>> used_;
  State x_;
  Covariance P_;
};

}  // namespace prf_predictor
