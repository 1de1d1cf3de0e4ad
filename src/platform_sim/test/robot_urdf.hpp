// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <sstream>
#include <string>

namespace platform_sim {

/// The robot description that the package is made for; the build gives its place.
inline std::string robot_urdf() {
  std::ifstream file(ROBOT_URDF_FILE);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace platform_sim
