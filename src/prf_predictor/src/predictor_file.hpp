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
};

// Throws std::invalid_argument when it cannot be read or is none.
[[nodiscard]] PredictorFile read_predictor_file(const std::string& path);

}  // namespace prf_predictor
