// SPDX-License-Identifier: BSD-3-Clause
// Offline inference of the HMM's states over a whole run: each state is inferred from earlier and
// later observations.
//
// Forward-backward, scaled at every step (Rabiner 1989, section V.A), with s_k the scale:
//   alpha_k = (A^T alpha_{k-1}) b(o_k) / s_k,     beta_k = A b(o_{k+1}) beta_{k+1} / s_{k+1},
//   P(state k | all) = alpha_k beta_k,            ln P(all) = sum ln s_k.
// An observation without a velocity has b = 1 in every state; one with a label excludes the others.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prf_decision/hmm.hpp"

namespace prf_decision {

struct Observation {
  std::optional<Eigen::Vector3d> velocity;  // m/s; none: the target was not measured
  std::optional<Intent> label;              // none: not known
  // As in ObservedMotion; without a velocity they do not count.
  double spread = 0;                               // m/s
  std::optional<double> deviation = std::nullopt;  // m
};
using Sequence = std::vector<Observation>;

struct SmoothingResult {
  Eigen::Matrix3Xd posterior;                             // one column per observation, sums to 1
  Eigen::Matrix3d transitions = Eigen::Matrix3d::Zero();  // expected number from row to column
  double log_likelihood = 0;
};

// The parameters are not validated here: the states may be in any order. std::invalid_argument for
// an empty sequence, and for one that has probability 0 in the model.
[[nodiscard]] SmoothingResult smooth(const HmmParams& parameters, const Sequence& sequence);

struct ViterbiResult {
  std::vector<Intent> states;
  double log_probability = 0;  // of states and observations together
};

// The single most probable sequence of states (Viterbi). Refuses as smooth() does.
[[nodiscard]] ViterbiResult most_probable_path(const HmmParams& parameters,
                                               const Sequence& sequence);

// A run drawn from the model, every observation labelled. The same seed gives the same run.
// Validates the parameters.
[[nodiscard]] Sequence draw(const HmmParams& parameters, std::size_t observations,
                            std::uint32_t seed);

}  // namespace prf_decision
