// SPDX-License-Identifier: BSD-3-Clause
#include "params.hpp"

#include <prf_core/require.hpp>
#include <prf_ros/private_parameters.hpp>

namespace prf_perception {

void TagDetectorNodeParams::validate() const {
  detector.validate();
  for (const int id : tag_ids) prf_core::require_between("an entry of tag_ids", id, 0, 65535);
  prf_core::require_between("info_wait", info_wait, 0.0, 10.0, "s");
  prf_core::require_between("stamp_offset", stamp_offset, -0.5, 0.5, "s");
}

TagDetectorNodeParams load_params(const ros::NodeHandle& private_node) {
  prf_ros::PrivateParameters values(private_node);
  TagDetectorNodeParams params;
  params.detector.family = values.text("tag_family");
  params.detector.tag_size = values.number("tag_size");
  params.detector.max_hamming = values.integer("max_hamming");
  params.detector.min_decision_margin = values.number("min_decision_margin");
  params.detector.quad_decimate = values.number("quad_decimate");
  params.detector.min_white_black_diff = values.integer("min_white_black_diff");
  params.detector.error_model.corner_sigma = values.number("corner_sigma");
  params.detector.error_model.position_floor = values.number("position_floor");
  params.detector.error_model.orientation_floor = values.number("orientation_floor");
  for (const int id : values.integers("tag_ids")) params.tag_ids.insert(id);
  params.info_wait = values.number("info_wait");
  params.stamp_offset = values.number("stamp_offset");
  values.refuse_unknown();
  params.validate();
  return params;
}

}  // namespace prf_perception
