// SPDX-License-Identifier: BSD-3-Clause
// Parameters of tag_detector_node, documented in config/tag_detector.yaml.
#pragma once

#include <prf_ros/private_parameters.hpp>

#include <set>
#include <stdexcept>
#include <string>

#include "prf_perception/tag_detector.hpp"

namespace prf_perception {

struct NodeParams {
  TagDetectorParams detector;
  std::set<int> tag_ids;
  double info_wait;
};

inline NodeParams load(const ros::NodeHandle& private_node) {
  prf_ros::PrivateParameters parameters(private_node);
  NodeParams params;
  params.detector.family = parameters.text("tag_family");
  params.detector.tag_size = parameters.number("tag_size");
  params.detector.max_hamming = parameters.integer("max_hamming");
  params.detector.min_decision_margin = parameters.number("min_decision_margin");
  params.detector.quad_decimate = parameters.number("quad_decimate");
  params.detector.min_white_black_diff = parameters.integer("min_white_black_diff");
  params.detector.error_model.corner_sigma = parameters.number("corner_sigma");
  params.detector.error_model.position_floor = parameters.number("position_floor");
  params.detector.error_model.orientation_floor = parameters.number("orientation_floor");
  for (const int id : parameters.integers("tag_ids")) {
    if (id < 0) throw std::invalid_argument("tag_ids has " + std::to_string(id) + ", must be >= 0");
    params.tag_ids.insert(id);
  }
  params.info_wait = parameters.number("info_wait");
  if (!(params.info_wait >= 0 && params.info_wait <= 10)) {
    throw std::invalid_argument("info_wait = " + std::to_string(params.info_wait) +
                                ", must be 0 .. 10 s");
  }
  parameters.refuse_unknown();
  return params;
}

}  // namespace prf_perception
