// SPDX-License-Identifier: BSD-3-Clause
#include "params.hpp"

#include <prf_ros/private_parameters.hpp>

#include <map>
#include <prf_core/require.hpp>

#include "prf_predictor/predictors.hpp"

namespace prf_predictor {

using prf_core::require;
using prf_core::require_between;

void TargetPredictorParams::validate() const {
  require(!planning_frame.empty(), "planning_frame", "\"\"", "a frame's name");
  require(!tag_frame_prefix.empty(), "tag_frame_prefix", "\"\"", "the start of a frame's name");
  require(tag_id >= 0, "tag_id", tag_id, ">= 0");
  require(!horizons.empty() && horizons.front() == 0, "horizons",
          horizons.empty() ? "[]" : std::to_string(horizons.front()) + " at first",
          "a list that starts with 0 s");
  for (std::size_t i = 1; i < horizons.size(); ++i) {
    require(horizons[i] > horizons[i - 1] && horizons[i] <= 60, "horizons", horizons[i],
            "strictly rising and <= 60 s");
  }
  require_between("tf_wait", tf_wait, 0, 10, "s");
  require_between("measurement_scale", measurement_scale, 1e-6, 1e6);
  defaults.validate();
  tracker.validate();
}

TargetPredictorParams load_params(const ros::NodeHandle& private_handle) {
  prf_ros::PrivateParameters values(private_handle);
  TargetPredictorParams params;
  params.planning_frame = values.text("planning_frame");
  params.tag_frame_prefix = values.text("tag_frame_prefix");
  params.tag_id = values.integer("tag_id");
  params.horizons = values.numbers("horizons");
  params.tf_wait = values.number("tf_wait");
  params.measurement_scale = values.number("measurement_scale");
  params.defaults = {values.number("position_sigma"), values.number("orientation_sigma")};
  params.tracker.gate_probability = values.number("gate_probability");
  params.tracker.gate_speed = values.number("gate_speed");
  params.tracker.orientation_gate_sigma = values.number("orientation_gate_sigma");
  params.tracker.orientation_gate_speed = values.number("orientation_gate_speed");
  params.tracker.reacquire_hits = values.integer("reacquire_hits");
  params.tracker.coast_after = values.number("coast_after");
  params.tracker.lost_after = values.number("lost_after");

  const std::string name = values.text("predictor");
  std::map<std::string, double> of_predictor;
  for (const std::string& key : predictor_parameters(name)) of_predictor[key] = values.number(key);
  params.predictor = make_predictor(name, of_predictor);
  values.refuse_unknown();
  params.validate();
  return params;
}

}  // namespace prf_predictor
