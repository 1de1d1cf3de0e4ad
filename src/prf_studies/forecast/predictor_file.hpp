// SPDX-License-Identifier: BSD-3-Clause
// The node's files for the commands; the node has them as parameters:
// config/predictors/<name>.yaml and config/target_predictor.yaml.
#pragma once

#include <map>
#include <string>

#include "prf_predictor/target_tracker.hpp"

namespace prf_predictor {

struct PredictorFile {
  std::string predictor;
  std::map<std::string, double> values;
  double measurement_scale = 1.0;  // of the measurements' covariance
};

// Both throw std::invalid_argument when it cannot be read or is none.
[[nodiscard]] PredictorFile read_predictor_file(const std::string& path);
[[nodiscard]] TrackerParams read_tracker_params(const std::string& path);

[[nodiscard]] std::string text_of(const PredictorFile& file);

}  // namespace prf_predictor
