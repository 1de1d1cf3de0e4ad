// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the predictors as the node gets them, from config/predictors.
#pragma once

#include <yaml-cpp/yaml.h>

#include <map>
#include <string>

#include "prf_predictor/periodic_params.hpp"
#include "prf_predictor/predictors.hpp"

namespace prf_predictor {

inline std::map<std::string, double> values_of(const std::string& name) {
  const YAML::Node file = YAML::LoadFile(std::string(CONFIG) + "/predictors/" + name + ".yaml");
  std::map<std::string, double> values;
  for (const std::string& key : predictor_parameters(name)) values[key] = file[key].as<double>();
  return values;
}

inline PeriodicParams periodic_params() {
  const auto values = values_of("periodic");
  PeriodicParams params;
  for (const auto& [name, member] : PeriodicParams::members()) params.*member = values.at(name);
  return params;
}

}  // namespace prf_predictor
