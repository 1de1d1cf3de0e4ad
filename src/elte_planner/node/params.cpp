// SPDX-License-Identifier: BSD-3-Clause
#include "params.hpp"

#include <prf_core/require.hpp>
#include <prf_ros/private_parameters.hpp>

namespace elte_planner {

void SkillPlannerParams::validate() const {
  session.validate();
  prf_core::require(!files.demonstration.empty(), "demonstration", "''", "the name of a CSV file");
  prf_core::require(!files.frame.empty(), "frame", "''", "the name of a frame");
  prf_core::require(!target_frame.empty() && target_frame != files.frame, "target_frame",
                    target_frame, "the name of a frame other than `frame`");
  files.limits.validate();
  prf_core::require_between("tick_period", tick_period, 0.001, 0.1, "s");
  prf_core::require_between("late_after", late_after, 1e-6, 10.0, "s");
}

SkillPlannerParams load_params(const ros::NodeHandle& private_node) {
  prf_ros::PrivateParameters values(private_node);
  SkillPlannerParams params;
  params.files.demonstration = values.text("demonstration");
  params.files.folders = values.text("demonstration_folders");
  params.files.limits.reach = values.number("reach");
  params.files.frame = values.text("frame");
  params.tick_period = values.number("tick_period");
  params.late_after = values.number("late_after");
  params.target_frame = values.text("target_frame");
  params.avoid = values.flag("avoid");
  SessionParams& session = params.session;
  session.planner = values.text("planner");
  session.adaptation = values.flag("framework") ? Adaptation::kContinuous : Adaptation::kOnce;
  session.nodes = values.integer("nodes");
  session.weights.elastic = values.number("w_elastic");
  session.weights.bending = values.number("w_bending");
  session.max_step = values.number("max_step");
  session.horizon_max = values.number("horizon_max");
  session.confidence = values.number("confidence");
  session.radius_min = values.number("radius_min");
  session.radius_max = values.number("radius_max");
  session.approach_length = values.number("approach_length");
  session.obstacles = obstacles_from(values.text("obstacles"));
  session.clearance = values.number("clearance");
  session.via_points = via_points_from(values.text("via_points"));
  values.refuse_unknown();
  params.validate();
  return params;
}

}  // namespace elte_planner
