// SPDX-License-Identifier: BSD-3-Clause
#include "params.hpp"

#include <prf_ros/private_parameters.hpp>

#include <stdexcept>

namespace elte_planner {

NodeParams load_node_params(const ros::NodeHandle& private_handle) {
  prf_ros::PrivateParameters values(private_handle);
  NodeParams params;
  params.demonstration = values.text("demonstration");
  params.frame = values.text("frame");
  params.session.planner = values.text("planner");
  params.session.framework = values.flag("framework");
  params.session.nodes = values.integer("nodes");
  params.session.weights.elastic = values.number("w_elastic");
  params.session.weights.bending = values.number("w_bending");
  params.session.max_step = values.number("max_step");
  params.session.horizon_max = values.number("horizon_max");
  params.session.confidence = values.number("confidence");
  params.session.radius_min = values.number("radius_min");
  params.session.radius_max = values.number("radius_max");
  params.session.approach_length = values.number("approach_length");
  params.late_after = values.number("late_after");
  values.refuse_unknown();
  params.session.validate();
  if (params.demonstration.empty()) {
    throw std::invalid_argument("demonstration is '', must name a CSV file");
  }
  if (params.frame.empty()) throw std::invalid_argument("frame is '', must name a frame");
  if (!(params.late_after >= 1e-6 && params.late_after <= 10.0)) {
    throw std::invalid_argument("late_after is " + std::to_string(params.late_after) +
                                ", must be within [1e-6, 10] s");
  }
  return params;
}

}  // namespace elte_planner
