// SPDX-License-Identifier: BSD-3-Clause
// Learns the HMM's parameters from runs, each a sequence of observations (Baum-Welch: maximum
// likelihood by expectation maximisation), with labels of the states or without.
//
//   E   gamma_k = P(state k | run), xi = expected transitions            (hmm_sequence.hpp)
//   M   initial_i = mean over runs of gamma_0i          A_ij = xi_ij / sum_j xi_ij
//       mean_i = sum gamma_ki o_k / sum gamma_ki        (or 0)
//       covariance_i = sum gamma_ki ((o_k - mean_i)(o_k - mean_i)^T + s_k^2/3 I) / sum gamma_ki
//       deviation_i  = mean and standard deviation of x_k, weighted by gamma_ki, where it is known
// s_k is the spread of an observation: the model's density is an expectation over it (hmm.hpp).
// Where every observation is labelled gamma is 0 or 1, and the first iteration gives the result.
//
// Without labels the likelihood does not change when states change names: they are named by rising
// mean square speed E|o|^2, Forward, Pause, Reverse. With labels the names are the labels'. In both
// cases a model that HmmParams::validate() refuses is discarded.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "prf_decision/hmm/hmm_sequence.hpp"

namespace prf_decision {

struct LearningParams {
  int restarts = 8;          // from other first guesses; the most likely result is taken
  int max_iterations = 500;  // of each
  double tolerance = 1e-8;   // rise of ln P per observation below which it has converged
  std::uint32_t seed = 1;    // of the first guesses
  // Whether the means of the states are learnt; false: they are zero. With zero means the states
  // differ in the strength of a sway; with free ones they may become its directions.
  bool free_means = false;

  void validate() const;
};

struct EmStepResult {
  HmmParams parameters;       // states in the order of those it was given
  double log_likelihood = 0;  // of the parameters that it was given
};

// One iteration. std::runtime_error names a state with too little data: expected observations
// (sum of gamma) below kLeastObservations, or a singular covariance.
inline constexpr double kLeastObservations = 4;
[[nodiscard]] EmStepResult em_step(const HmmParams& parameters, const std::vector<Sequence>& runs,
                                   bool free_means);

struct LearningResult {
  HmmParams parameters;
  std::vector<double> log_likelihood;  // one per iteration
  bool converged = false;
  int restart = 0;                   // the one that gave these parameters
  std::vector<std::string> refused;  // for each restart that failed: why
};

using OnIteration = std::function<void(int restart, int iteration, double log_likelihood)>;

// std::invalid_argument when no restart leads to a valid model; the message says why.
[[nodiscard]] LearningResult learn(const std::vector<Sequence>& runs, const LearningParams& options,
                                   const OnIteration& on_iteration = {});

}  // namespace prf_decision
