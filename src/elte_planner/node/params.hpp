// SPDX-License-Identifier: BSD-3-Clause
// Parameters of skill_planner_node, documented in config/skill_planner.yaml.
#pragma once

#include <ros/node_handle.h>

#include "elte_planner/current_skill.hpp"

namespace elte_planner {

struct SkillPlannerParams {
  SkillFiles files;
  double late_after = 0.0;   // s, a solve that takes longer is late; within [1e-6, 10]
  double tick_period = 0.0;  // s, between two execution/progress; within [0.001, 0.1]
  std::string target_frame;  // in which obstacles that move with the target are given
  bool avoid = true;         // whether the topic of obstacles is heeded
  SessionParams session;

  void validate() const;  // throws std::invalid_argument with name, value and bound
};

// Reads the node's private namespace: every key required, no other key allowed. Throws
// std::invalid_argument naming the key, the value and what is allowed.
[[nodiscard]] SkillPlannerParams load_params(const ros::NodeHandle& private_node);

}  // namespace elte_planner
