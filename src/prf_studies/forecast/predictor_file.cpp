// SPDX-License-Identifier: BSD-3-Clause
#include "predictor_file.hpp"

#include <yaml-cpp/yaml.h>

#include <prf_core/readable_file.hpp>
#include <stdexcept>

#include "prf_predictor/predictors.hpp"

namespace prf_studies {

PredictorFile read_predictor_file(const std::string& path) {
  prf_core::require_readable_file(path);
  try {
    const YAML::Node root = YAML::LoadFile(path);
    PredictorFile file;
    for (const auto& entry : root) {
      const auto key = entry.first.as<std::string>();
      if (key == "predictor") {
        file.predictor = entry.second.as<std::string>();
      } else if (key == "measurement_scale") {
        file.measurement_scale = entry.second.as<double>();
      } else {
        file.values[key] = entry.second.as<double>();
      }
    }
    if (file.predictor.empty()) throw std::invalid_argument(path + " has no key predictor");
    return file;
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(path + " cannot be read as a predictor's file: " + error.what());
  }
}

prf_predictor::TrackerParams read_tracker_params(const std::string& path) {
  prf_core::require_readable_file(path);
  try {
    const YAML::Node root = YAML::LoadFile(path);
    prf_predictor::TrackerParams params;
    params.gate_probability = root["gate_probability"].as<double>();
    params.gate_speed = root["gate_speed"].as<double>();
    params.orientation_gate_sigma = root["orientation_gate_sigma"].as<double>();
    params.orientation_gate_speed = root["orientation_gate_speed"].as<double>();
    params.reacquire_hits = root["reacquire_hits"].as<int>();
    params.coast_after = root["coast_after"].as<double>();
    params.lost_after = root["lost_after"].as<double>();
    params.validate();
    return params;
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(path + " cannot be read as target_predictor.yaml: " + error.what());
  }
}

std::unique_ptr<prf_predictor::TargetPredictor> PredictorFile::make() const {
  return prf_predictor::make_predictor(predictor, values);
}

std::string PredictorFile::text() const {
  YAML::Emitter text;
  text << YAML::BeginMap << YAML::Key << "predictor" << YAML::Value << predictor;
  for (const auto& [key, value] : values) text << YAML::Key << key << YAML::Value << value;
  text << YAML::Key << "measurement_scale" << YAML::Value << measurement_scale << YAML::EndMap;
  return std::string(text.c_str()) + "\n";
}

}  // namespace prf_studies
