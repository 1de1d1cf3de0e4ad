// SPDX-License-Identifier: BSD-3-Clause
// A position as a sum of independent parts, the same for the three axes but for their states: a
// linear state-space model with two numbers of state per part, and its Kalman filter.
//
// Parts, with the position that they add first in their state:
//   drift      VelocityDecay: position and velocity of slow, unbounded change
//   resonance  x'' = -2 z W x' - W^2 x + w: a swing of frequency W that w keeps alive; its
//              stationary standard deviation is s. The smaller z, the purer and the longer
//              remembered; z near 1 is a wander that returns to 0.
// With the stationary covariance S = diag(s^2, s^2 W^2), F = exp(A dt) and Q = S - F S F^T exactly.
//
// The noise of a measurement is taken as the same for the axes (its mean variance), so that they
// share covariance and gain.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prf_predictor/motion_model.hpp"

namespace prf_predictor {

struct Resonance {
  double frequency = 0.0;  // W, rad/s, > 0
  double damping = 0.0;    // z, > 0 and < 1
  double sigma = 0.0;      // s, m, > 0
};

struct Transition {
  Eigen::Matrix2d F;
  Eigen::Matrix2d Q;
};

[[nodiscard]] Transition transition(const VelocityDecay& drift, double dt);
[[nodiscard]] Transition transition(const Resonance& resonance, double dt);

// A drift, which is part 0, and resonances: what models are put together from.
struct Parts {
  VelocityDecay drift;
  std::vector<Resonance> resonances;

  [[nodiscard]] std::vector<Transition> transitions(double dt) const;
};

// The belief of one model, which consists of some of the parts, by their numbers.
class SpectralBelief {
 public:
  static constexpr int kMostParts = 12;

  struct Forecast {
    Eigen::Vector3d position;
    Eigen::Vector3d velocity;
    Eigen::Matrix2d covariance;  // of position and velocity, for each axis
  };

  SpectralBelief(const Parts& parts, std::shared_ptr<const std::vector<int>> used,
                 const Eigen::Vector3d& position, double variance);

  void advance(const std::vector<Transition>& transitions);
  void correct(const Eigen::Vector3d& position, double variance);
  [[nodiscard]] Forecast forecast(const std::vector<Transition>& transitions) const;
  // The position alone.
  [[nodiscard]] Eigen::Vector3d position(const std::vector<Transition>& transitions) const;
  [[nodiscard]] Eigen::MatrixXd covariance() const { return P_; }

 private:
  static constexpr int kMost = 2 * kMostParts;
  using State = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMost, 3>;
  using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;

  std::shared_ptr<const std::vector<int>> used_;
  State x_;
  Covariance P_;
};

}  // namespace prf_predictor
