// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace platform_sim {

/// A file of config/profiles, as it was when this was built.
struct PackagedProfile {
  const char* name;
  const char* text;
};

/// In alphabetical order.
[[nodiscard]] const std::vector<PackagedProfile>& packaged_profiles();

}  // namespace platform_sim
