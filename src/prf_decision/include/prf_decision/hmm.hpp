// SPDX-License-Identifier: BSD-3-Clause
// Hidden Markov model of what the target's motion allows: go forward, pause, or go back.
//
// Observation o: velocity of the target in the planning frame, m/s, once for each forecast (one
// period of the camera). Hidden state i in the order Forward, Pause, Reverse, with Gaussian
// emission b_i(o) = N(o; mean_i, covariance_i). Where the velocity is known with a spread s only,
// the root mean square of what it does not show, ln b_i is its expectation over N(o, s^2/3 I):
//   E ln b_i = ln N(o; mean_i, covariance_i) - s^2/6 tr covariance_i^-1
// so that a larger spread speaks against states of narrow covariance, as a larger speed does.
// A model may observe one thing more: the deviation d of a hand that the arm's limits let follow
// the target (shadow_arm.hpp), as x = ln(d + kLeastDeviation), Gaussian and independent of the
// velocity:
//   ln b_i = (the above) + ln N(x; deviation_i.mean, deviation_i.sigma^2)
// Where d is not known the velocity alone counts.
// Observations of successive images are not independent, as the model has it: a filter that counts
// each of them fully is too sure of itself. ln b_i counts `weight` of it.
// Forward filter (Rabiner 1989, scaled), one step per observation:
//   predicted_j = sum_i posterior_i A_ij,   posterior_j = predicted_j b_j(o) / sum_k (same)
// The first observation uses the initial distribution as predicted.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

namespace prf_decision {

enum class Intent { kForward, kPause, kReverse };
inline constexpr std::size_t kIntents = 3;
// m/s. Faster observations are cut to it: all of them speak for Reverse as clearly.
inline constexpr double kMaxObservedSpeed = 20.0;
inline constexpr double kLeastDeviation = 0.003;  // m; what is below is noise
inline constexpr double kMaxDeviation = 10.0;     // m; larger ones are cut to it
inline constexpr std::array<const char*, kIntents> kIntentNames{"forward", "pause", "reverse"};

struct LogDeviation {
  double mean = 0;   // of ln(d / m + kLeastDeviation)
  double sigma = 1;  // its standard deviation
};

struct HmmParams {
  Eigen::Vector3d initial = Eigen::Vector3d::Zero();     // probabilities, sum 1
  Eigen::Matrix3d transition = Eigen::Matrix3d::Zero();  // row: from, column: to; rows sum to 1
  std::array<Eigen::Vector3d, kIntents> mean{};          // m/s
  std::array<Eigen::Matrix3d, kIntents> covariance{};    // m^2/s^2, positive definite
  // None: the model observes the velocity alone.
  std::optional<std::array<LogDeviation, kIntents>> deviation = std::nullopt;
  double weight = 1;  // of an observation in the filter, 0.01 .. 1

  // std::invalid_argument names the entry, its value and the bound. Besides wrong
  // probabilities and covariances it refuses states in the wrong order (mean_square_speed must
  // rise, and deviation.mean) and states that cannot be reached from every other.
  void validate() const;
};

struct ObservedMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s
  double spread = 0;  // m/s, root mean square of the motion that the velocity does not show
  std::optional<double> deviation = std::nullopt;  // m, of the shadow arm's hand; none: not known
};

// ln b_i(o) of every state.
class EmissionModel {
 public:
  // Refuses covariances that are not positive definite, by name.
  explicit EmissionModel(const HmmParams& parameters);

  // std::invalid_argument when the velocity is not finite.
  [[nodiscard]] Eigen::Vector3d log_density(const Eigen::Vector3d& velocity) const;
  // The expectation of the header, of the observation cut to kMaxObservedSpeed, without the weight.
  // std::invalid_argument when it is not finite, or spread or deviation are negative.
  [[nodiscard]] Eigen::Vector3d log_density(const ObservedMotion& observation) const;

 private:
  std::array<Eigen::Vector3d, kIntents> mean_;
  std::array<Eigen::Matrix3d, kIntents> whitening_;  // W with W^T W = covariance^-1
  Eigen::Vector3d log_norm_;                         // ln of the density at the mean
  Eigen::Vector3d precision_trace_;                  // tr covariance^-1, s^2/m^2
  std::optional<std::array<LogDeviation, kIntents>> deviation_;
};

// ln(d + kLeastDeviation) of a deviation cut to kMaxDeviation. std::invalid_argument when it is
// negative or not a number.
[[nodiscard]] double log_deviation(double deviation);

// E|o|^2 = |mean|^2 + tr covariance: the order of the states.
[[nodiscard]] double mean_square_speed(const HmmParams& parameters, std::size_t state);

struct HmmBelief {
  Eigen::Vector3d posterior = Eigen::Vector3d::Zero();  // sums to 1
  bool started = false;                                 // an observation or a prediction was made
  double log_likelihood = 0;                            // of all observations so far
  // Since a posterior that was no distribution was replaced by the initial one, until the next
  // observation. Such a belief counts as Reverse.
  bool was_reset = false;
};

// Whether the entries are probabilities and sum to 1; not-a-number is none.
[[nodiscard]] bool is_distribution(const Eigen::Vector3d& values);

class HmmFilter {
 public:
  // Validates the parameters.
  explicit HmmFilter(const HmmParams& parameters);

  [[nodiscard]] HmmBelief initial_belief() const;

  // One period with an observation. std::invalid_argument as from log_density(). Both functions
  // reset a posterior that is no distribution, given or computed.
  [[nodiscard]] HmmBelief observe(const HmmBelief& belief, const ObservedMotion& observation) const;

  // One period without an observation: the belief drifts toward the stationary distribution.
  [[nodiscard]] HmmBelief predict(const HmmBelief& belief) const;

 private:
  [[nodiscard]] HmmBelief checked(const HmmBelief& belief) const;

  HmmParams parameters_;
  EmissionModel emission_;
};

// The most probable state; the more cautious one when equal. Reverse after a reset, and when the
// posterior is no distribution.
[[nodiscard]] Intent most_probable(const HmmBelief& belief);

}  // namespace prf_decision
