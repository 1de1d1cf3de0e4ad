// SPDX-License-Identifier: BSD-3-Clause
#include "predictor_file.hpp"

#include <yaml-cpp/yaml.h>

#include <stdexcept>

namespace prf_predictor {

PredictorFile read_predictor_file(const std::string& path) {
  try {
    const YAML::Node root = YAML::LoadFile(path);
    PredictorFile file;
    for (const auto& entry : root) {
      const auto key = entry.first.as<std::string>();
      if (key == "predictor") {
        file.predictor = entry.second.as<std::string>();
      } else {
        file.values[key] = entry.second.as<double>();
      }
    }
    return file;
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(path + " is no predictor's file: " + error.what());
  }
}

}  // namespace prf_predictor
