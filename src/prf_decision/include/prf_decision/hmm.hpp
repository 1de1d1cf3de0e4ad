// SPDX-License-Identifier: BSD-3-Clause
// Hidden Markov model of what the target's motion allows: go forward, pause, or go back.
//
// Observation o: velocity of the target in the planning frame, m/s, once for each forecast (one
// period of the camera). Hidden state i in the order Forward, Pause, Reverse, with Gaussian
// emission b_i(o) = N(o; mean_i, covariance_i). Forward filter (Rabiner 1989, scaled), one step per
// observation:
//   predicted_j = sum_i posterior_i A_ij,   posterior_j = predicted_j b_j(o) / sum_k (same)
// The first observation uses the initial distribution as predicted.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace prf_decision {

enum class Intent { kForward, kPause, kReverse };
inline constexpr std::size_t kIntents = 3;
inline constexpr std::array<const char*, kIntents> kIntentNames{"forward", "pause", "reverse"};

struct HmmParams {
  Eigen::Vector3d initial = Eigen::Vector3d::Zero();     // probabilities, sum 1
  Eigen::Matrix3d transition = Eigen::Matrix3d::Zero();  // row: from, column: to; rows sum to 1
  std::array<Eigen::Vector3d, kIntents> mean{};          // m/s
  std::array<Eigen::Matrix3d, kIntents> covariance{};    // m^2/s^2, positive definite

  // std::invalid_argument names the entry, its value and the bound. Besides wrong
  // probabilities and covariances it refuses states in the wrong order (mean_square_speed must
  // rise) and states that cannot be reached from every other.
  void validate() const;
};

// ln b_i(o) of every state.
class EmissionModel {
 public:
  // Refuses covariances that are not positive definite, by name.
  explicit EmissionModel(const HmmParams& parameters);

  // std::invalid_argument when the velocity is not finite.
  [[nodiscard]] Eigen::Vector3d log_density(const Eigen::Vector3d& velocity) const;

 private:
  std::array<Eigen::Vector3d, kIntents> mean_;
  std::array<Eigen::Matrix3d, kIntents> whitening_;  // W with W^T W = covariance^-1
  Eigen::Vector3d log_norm_;                         // ln of the density at the mean
};

// E|o|^2 = |mean|^2 + tr covariance: the order of the states.
[[nodiscard]] double mean_square_speed(const HmmParams& parameters, std::size_t state);

struct HmmBelief {
  Eigen::Vector3d posterior = Eigen::Vector3d::Zero();  // sums to 1
  bool started = false;                                 // an observation or a prediction was made
  double log_likelihood = 0;                            // of all observations so far
};

class HmmFilter {
 public:
  // Validates the parameters.
  explicit HmmFilter(const HmmParams& parameters);

  [[nodiscard]] HmmBelief initial_belief() const;

  // One period with an observation. std::invalid_argument when the velocity is not finite.
  [[nodiscard]] HmmBelief observe(const HmmBelief& belief, const Eigen::Vector3d& velocity) const;

  // One period without an observation: the belief drifts toward the stationary distribution.
  [[nodiscard]] HmmBelief predict(const HmmBelief& belief) const;

 private:
  HmmParams parameters_;
  EmissionModel emission_;
};

// The most probable state; the more cautious one when equal.
[[nodiscard]] Intent most_probable(const HmmBelief& belief);

}  // namespace prf_decision
