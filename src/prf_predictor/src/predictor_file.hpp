// SPDX-License-Identifier: BSD-3-Clause
// A predictor's file, config/predictors/<name>.yaml, for the commands; the node has it as
// parameters.
#pragma once

#include <map>
#include <string>

namespace prf_predictor {

struct PredictorFile {
  std::string predictor;
  std::map<std::string, double> values;
  double measurement_scale = 1.0;  // of the measurements' covariance
};

// Throws std::invalid_argument when it cannot be read or is none.
[[nodiscard]] PredictorFile read_predictor_file(const std::string& path);

[[nodiscard]] std::string text_of(const PredictorFile& file);

}  // namespace prf_predictor
