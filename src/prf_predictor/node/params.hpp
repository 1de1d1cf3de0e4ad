// SPDX-License-Identifier: BSD-3-Clause
// Parameters of target_predictor_node, documented in config/target_predictor.yaml.
#pragma once

#include <prf_ros/private_parameters.hpp>

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <prf_core/require.hpp>
#include "prf_predictor/predictors.hpp"
#include "prf_predictor/target_tracker.hpp"

namespace prf_predictor {

using prf_core::require;

struct NodeParams {
  std::string planning_frame;
  int tag_id = 0;
  std::vector<double> horizons;
  double tf_wait = 0.0;
  double measurement_scale = 0.0;
  std::shared_ptr<const TargetPredictor> predictor;
  MeasurementDefaults defaults;
  TrackerParams tracker;
};

inline void validate(const NodeParams& params) {
  require(!params.planning_frame.empty(), "planning_frame", "\"\"", "a frame's name");
  require(params.tag_id >= 0, "tag_id", params.tag_id, ">= 0");
  require(!params.horizons.empty() && params.horizons.front() == 0, "horizons",
          params.horizons.empty() ? "[]" : std::to_string(params.horizons.front()) + " at first",
          "a list that starts with 0 s");
  for (std::size_t i = 1; i < params.horizons.size(); ++i) {
    require(params.horizons[i] > params.horizons[i - 1] && params.horizons[i] <= 60, "horizons",
            params.horizons[i], "strictly rising and <= 60 s");
  }
  require(params.tf_wait >= 0 && params.tf_wait <= 10, "tf_wait", params.tf_wait, "0 .. 10 s");
  require(params.measurement_scale > 0 && params.measurement_scale <= 1e6, "measurement_scale",
          params.measurement_scale, "> 0 and <= 1e6");
  validate(params.defaults);
  validate(params.tracker);
}

// The predictor by its name, with the parameters that it has.
inline std::unique_ptr<TargetPredictor> load_predictor(prf_ros::PrivateParameters& parameters) {
  const std::string name = parameters.text("predictor");
  std::map<std::string, double> values;
  for (const std::string& key : predictor_parameters(name)) values[key] = parameters.number(key);
  return make_predictor(name, values);
}

inline NodeParams load(const ros::NodeHandle& private_node) {
  prf_ros::PrivateParameters parameters(private_node);
  NodeParams params;
  params.planning_frame = parameters.text("planning_frame");
  params.tag_id = parameters.integer("tag_id");
  params.horizons = parameters.numbers("horizons");
  params.tf_wait = parameters.number("tf_wait");
  params.predictor = load_predictor(parameters);
  params.measurement_scale = parameters.number("measurement_scale");
  params.defaults = {parameters.number("position_sigma"), parameters.number("orientation_sigma")};
  params.tracker.gate_probability = parameters.number("gate_probability");
  params.tracker.gate_speed = parameters.number("gate_speed");
  params.tracker.orientation_gate_sigma = parameters.number("orientation_gate_sigma");
  params.tracker.reacquire_hits = parameters.integer("reacquire_hits");
  params.tracker.coast_after = parameters.number("coast_after");
  params.tracker.lost_after = parameters.number("lost_after");
  parameters.refuse_unknown();
  validate(params);
  return params;
}

}  // namespace prf_predictor
