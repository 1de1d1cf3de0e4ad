// SPDX-License-Identifier: BSD-3-Clause
// Every predictor by its name, as the parameter `predictor` and the launch argument give it. What
// each is and the values of its parameters: config/predictors/<name>.yaml.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "prf_predictor/target_predictor.hpp"

namespace prf_predictor {

[[nodiscard]] std::vector<std::string> predictor_names();

// Of the predictor of this name. Throws std::invalid_argument for a name that there is not.
[[nodiscard]] std::vector<std::string> predictor_parameters(const std::string& name);

// `values` has exactly the parameters of this predictor. Throws std::invalid_argument naming the
// one that is missing, unknown or out of its bounds.
[[nodiscard]] std::unique_ptr<TargetPredictor> make_predictor(
    const std::string& name, const std::map<std::string, double>& values);

}  // namespace prf_predictor
