// SPDX-License-Identifier: BSD-3-Clause
// Parameters of target_predictor_node, documented in config/target_predictor.yaml.
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

#include "prf_predictor/target_tracker.hpp"

namespace prf_predictor {

struct TargetPredictorParams {
  std::string planning_frame;
  std::string tag_frame_prefix;
  int tag_id = 0;
  std::vector<double> horizons;  // s
  double tf_wait = 0.0;          // s
  double measurement_scale = 0.0;
  MeasurementDefaults defaults;
  TrackerParams tracker;
  std::shared_ptr<const TargetPredictor> predictor;

  void validate() const;
};

// Throws std::invalid_argument naming what is missing, unknown or out of its bounds.
[[nodiscard]] TargetPredictorParams load_params(const ros::NodeHandle& private_handle);

}  // namespace prf_predictor
