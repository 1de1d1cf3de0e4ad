// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/robot_files.hpp"

#include <ros/package.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace platform_sim {

// The description is generated, so in a devel space it is not where the package's sources are.
std::string installed_robot_description() {
  const std::string in_prefix = "/share/jaco_v60_description/urdf/jaco_v60.urdf";
  const char* prefixes = std::getenv("CMAKE_PREFIX_PATH");
  std::istringstream paths(prefixes == nullptr ? "" : prefixes);
  for (std::string prefix; std::getline(paths, prefix, ':');) {
    std::ifstream file(prefix + in_prefix);
    if (file) return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  throw std::runtime_error("no *" + in_prefix + " in CMAKE_PREFIX_PATH: is a workspace sourced?");
}

ArmVector configured_arm_start() {
  const std::string path = ros::package::getPath("platform_sim") + "/config/platform_sim.yaml";
  try {
    const auto values = YAML::LoadFile(path)["initial_positions"].as<std::vector<double>>();
    if (values.size() != 7) {
      throw std::runtime_error(std::to_string(values.size()) + " numbers, must be 7");
    }
    return Eigen::Map<const ArmVector>(values.data());
  } catch (const std::exception& error) {
    throw std::runtime_error("initial_positions of " + path + ": " + error.what());
  }
}

}  // namespace platform_sim
