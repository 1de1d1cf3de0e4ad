// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <prf_core/quoted.hpp>
#include <sstream>
#include <stdexcept>

#include "prf_robots/robot.hpp"

namespace prf_robots {
namespace {

namespace fs = std::filesystem;

// Of the sourced workspaces, the first one first.
std::vector<fs::path> robot_folders() {
  std::vector<fs::path> folders;
  const char* prefixes = std::getenv("CMAKE_PREFIX_PATH");
  std::istringstream list(prefixes == nullptr ? "" : prefixes);
  for (std::string prefix; std::getline(list, prefix, ':');) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(prefix + "/share/prf_robots/robots", none)) {
      if (entry.is_directory()) folders.push_back(entry.path());
    }
  }
  return folders;
}

}  // namespace

std::vector<std::string> robot_names() {
  std::vector<std::string> names;
  for (const fs::path& folder : robot_folders()) names.push_back(folder.filename().string());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::string robot_folder(const std::string& name_or_path) {
  if (name_or_path.find('/') != std::string::npos) return name_or_path;
  for (const fs::path& folder : robot_folders()) {
    if (folder.filename() == name_or_path) return folder.string();
  }
  std::string text = "robot = " + prf_core::quoted(name_or_path) + ", must be ";
  for (const std::string& name : robot_names()) text += name + ", ";
  throw std::invalid_argument(text + "or the path of a folder, with a /");
}

}  // namespace prf_robots
