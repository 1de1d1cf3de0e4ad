// SPDX-License-Identifier: BSD-3-Clause
// Runs to judge the arm's ability by: forecasts with the target's true path.
#pragma once

#include <cstdint>
#include <string>

#include "ability.hpp"

namespace prf_studies {

// A recorded motion (table with time, tag_x .. tag_qw: the tag in the arm's base), seen through a
// camera of 30 Hz and forecast by the predictor of these files. The seed draws the camera's noise.
[[nodiscard]] ObservedRun run_from_motion(const std::string& path, const std::string& node_file,
                                          const std::string& predictor_file, std::uint32_t seed);

// target/forecast of a bag. The truth is where later forecasts see the target.
[[nodiscard]] ObservedRun run_from_bag(const std::string& path);

}  // namespace prf_studies
