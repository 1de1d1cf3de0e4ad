// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "elte_planner/skill_session.hpp"

namespace elte_planner {

struct NodeParams {
  std::string demonstration;  // CSV file
  std::string frame;          // planning frame that demonstration and messages must be in
  double late_after = 0.0;    // s, a solve that takes longer is late; within [1e-6, 10]
  SessionParams session;
};

// Reads the node's private namespace: every key required, no other key allowed. Throws
// std::invalid_argument naming the key, the value and what is allowed.
[[nodiscard]] NodeParams load_node_params(const ros::NodeHandle& private_handle);

}  // namespace elte_planner
