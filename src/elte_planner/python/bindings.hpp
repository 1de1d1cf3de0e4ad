// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of the module elte_planner._core, one file each.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "elte_planner/elte_energy.hpp"

namespace elte_planner {

// laplacian: "free_ends" or "row_normalised". Throws std::invalid_argument.
ElteWeights weights_from(double elastic, double bending, const std::string& laplacian);

void bind_planners(pybind11::module_& m);
void bind_demonstration(pybind11::module_& m);

}  // namespace elte_planner
