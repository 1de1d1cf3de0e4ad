// SPDX-License-Identifier: BSD-3-Clause
// Parameters of tag_detector_node, documented in config/tag_detector.yaml.
#pragma once

#include <ros/node_handle.h>

#include <set>

#include "prf_perception/tag_detector.hpp"

namespace prf_perception {

struct TagDetectorNodeParams {
  TagDetectorParams detector;
  std::set<int> tag_ids;
  double info_wait = 0.0;     // s
  double stamp_offset = 0.0;  // s

  void validate() const;  // throws std::invalid_argument with name, value and bound
};

// Reads the node's private namespace: every key required, no other key allowed. Throws
// std::invalid_argument naming the key, its value and what is allowed.
[[nodiscard]] TagDetectorNodeParams load_params(const ros::NodeHandle& private_node);

}  // namespace prf_perception
