// SPDX-License-Identifier: BSD-3-Clause
// The decision node's parameters; config/decision.yaml states units and meaning.
#pragma once

#include <prf_robots/robot.hpp>
#include <prf_ros/private_parameters.hpp>
#include <prf_ros/reconfigurable.hpp>
#include <string>
#include <vector>

#include "prf_decision/skill_executive.hpp"
#include "prf_decision/tick_gate.hpp"

namespace prf_decision {

using prf_robots::Robot;

struct DecisionNodeParams {
  prf_robots::Robot robot;
  double tick_period = 0.0;  // s, of joint_states and control/status
  GateParams gate;
  DecisionParams decision;

  void validate() const;
};

// std::invalid_argument names the parameter or the HMM file, its value and the bound.
[[nodiscard]] DecisionNodeParams load_params(prf_ros::PrivateParameters values);

// The parameters that can be changed while the node runs, and `params` with changed ones.
[[nodiscard]] std::vector<prf_ros::ReconfigurableParams::Parameter> reconfigurable_numbers(
    const DecisionParams& params);
[[nodiscard]] DecisionParams with_reconfigured(const DecisionParams& params,
                                               const prf_ros::ReconfigurableParams::Values& values);

}  // namespace prf_decision
