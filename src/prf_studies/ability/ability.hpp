// SPDX-License-Identifier: BSD-3-Clause
// What the arm can do with a moving target: the shadow arm of prf_decision runs against a recorded
// motion, from forecasts as late as in a trial (at least `latency` old), without physics. Its
// deviation is here that of the hand from goal_in_target on the true target.
//
// An instant is labelled by the largest deviation D of the following `horizon`:
//   Forward   D <= clearance                    the task's accuracy is kept
//   Pause     clearance < D <= box_clearance    a hand that stands with the target touches nothing
//   Reverse   D > box_clearance                 nor does that help
// The skill's own speed (0.03 m/s) is not added: it is a tenth of that of such targets.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <prf_core/forecast.hpp>
#include <prf_decision/hmm.hpp>
#include <prf_decision/shadow_arm.hpp>

namespace prf_studies {

struct ObservedRun {
  std::vector<prf_core::TargetForecast> forecasts;                      // stamps rise
  std::function<std::optional<prf_core::Pose>(prf_core::Stamp)> truth;  // none: not known
};

struct AbilityParams {
  prf_decision::ArmLimits arm;
  prf_control::JointVector start;  // rad; the arm begins in the solution nearest to it
  prf_core::Pose goal_in_target;
  double lead = 0.04;           // s, 0 .. 1
  double latency = 0.05;        // s, from an image to its first command, 0 .. 1
  double warm_up = 1.0;         // s from the first forecast that count for nothing, 0 .. 60
  double horizon = 0.5;         // s, 0.01 .. 60
  double clearance = 0.04;      // m, 0.001 .. 1
  double box_clearance = 0.06;  // m, > clearance, at most 1

  // std::invalid_argument names the parameter, its value and the bound.
  void validate() const;
};

struct Instant {
  prf_core::Stamp stamp{0};
  double deviation = 0;  // m; not a number where the truth is not known
};

struct Followed {
  std::vector<Instant> instants;                // one for each tick of 10 ms, at the hand's stamps
  std::vector<std::optional<double>> observed;  // ShadowArm::deviation() at each forecast
};

// std::invalid_argument when there is no forecast, or no joint position gives any goal.
[[nodiscard]] Followed follow(const ObservedRun& run, const AbilityParams& params);

// The label of each forecast; none during the warm-up, where the truth is not known, and where the
// run ends within the horizon.
[[nodiscard]] std::vector<std::optional<prf_decision::Intent>> labels(
    const ObservedRun& run, const std::vector<Instant>& instants, const AbilityParams& params);

// Deviation that is not exceeded for this share of the instants after the warm-up, m.
[[nodiscard]] double held_within(const std::vector<Instant>& instants, double share,
                                 const AbilityParams& params);

}  // namespace prf_studies
