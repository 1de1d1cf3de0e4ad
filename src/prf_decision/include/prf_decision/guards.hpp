// SPDX-License-Identifier: BSD-3-Clause
// What the HMM cannot see: whether target, forecast and goal can be acted on at all.
#pragma once

#include <optional>
#include <string>

#include "prf_decision/decision_fsm.hpp"
#include "prf_decision/types.hpp"

namespace prf_decision {

struct GuardParams {
  Duration pause_after{0};                             // target unseen, T1
  Duration reverse_after{0};                           // T2 > T1
  Duration stop_after{0};                              // T3 > T2
  Eigen::Vector3d shoulder = Eigen::Vector3d::Zero();  // its centre in the planning frame, m
  double max_reach = 0;                                // hand from the shoulder's centre, m
  double workspace_radius = 0;                         // target from the shoulder's centre, m
  double max_target_speed = 0;                         // m/s

  void validate() const;
};

struct Objection {
  Event event = Event::kHazard;
  std::string reason;
};

// The target was last seen `age` ago.
[[nodiscard]] std::optional<Objection> object_to_age(const GuardParams& guards, Duration age);

// A prediction is outside the workspace or too fast.
[[nodiscard]] std::optional<Objection> object_to_forecast(const GuardParams& guards,
                                                          const TargetForecast& forecast);

// The hand's goal is farther than the arm reaches, or no joint position within limits gives it.
[[nodiscard]] std::optional<Objection> object_to_goal(const GuardParams& guards,
                                                      const Pose& hand_goal);

}  // namespace prf_decision
