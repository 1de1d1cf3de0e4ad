// SPDX-License-Identifier: BSD-3-Clause
// The files that the node of prf_predictor has as parameters, read without ROS:
// config/predictors/<name>.yaml and config/target_predictor.yaml.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "prf_predictor/target_tracker.hpp"

namespace prf_studies {

struct PredictorFile {
  std::string predictor;
  std::map<std::string, double> values;
  double measurement_scale = 1.0;  // of the measurements' covariance

  // Throws std::invalid_argument as make_predictor() does.
  [[nodiscard]] std::unique_ptr<prf_predictor::TargetPredictor> make() const;
  [[nodiscard]] std::string text() const;
};

// Both throw std::invalid_argument when the file cannot be read or is another one.
[[nodiscard]] PredictorFile read_predictor_file(const std::string& path);
[[nodiscard]] prf_predictor::TrackerParams read_tracker_params(const std::string& path);

}  // namespace prf_studies
