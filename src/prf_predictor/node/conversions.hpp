// SPDX-License-Identifier: BSD-3-Clause
// The messages of target_predictor_node to core types and back; common ones are in prf_ros.
#pragma once

#include <prf_msgs/TagDetection.h>
#include <prf_msgs/TargetForecast.h>

#include <prf_core/forecast.hpp>
#include <string>
#include <vector>

#include "prf_predictor/target_tracker.hpp"

namespace prf_predictor {

[[nodiscard]] CheckedMeasurement to_measurement(const prf_msgs::TagDetection& detection,
                                                const MeasurementDefaults& defaults);

[[nodiscard]] prf_msgs::TargetForecast to_message(
    const TrackState& state, const std::vector<prf_core::TargetPrediction>& predictions,
    const std::string& planning_frame);

}  // namespace prf_predictor
