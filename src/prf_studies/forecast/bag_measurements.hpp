// SPDX-License-Identifier: BSD-3-Clause
// The measurements of the target that a recorded bag holds, as the predictor's node would make
// them.
#pragma once

#include <string>
#include <vector>

#include "prf_predictor/tag_measurement.hpp"

namespace prf_studies {

struct TimedMeasurement {
  double time = 0.0;  // s
  prf_predictor::TagMeasurement measurement;
};

// Of the tag of this id in the planning frame, by the tf of each image's stamp, in the order of
// stamps. Throws std::invalid_argument when the bag cannot be read or has fewer than 30.
[[nodiscard]] std::vector<TimedMeasurement> measurements_in_bag(const std::string& path,
                                                                const std::string& planning_frame,
                                                                int tag_id);

}  // namespace prf_studies
