// SPDX-License-Identifier: BSD-3-Clause
#include "elte_planner/demonstration_folders.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "shown.hpp"

namespace elte_planner {
namespace {

namespace fs = std::filesystem;

bool is_inside(const fs::path& file, const fs::path& folder) {
  const auto [at, unused] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  (void)unused;
  return at == folder.end();
}

fs::path real_folder(const fs::path& folder) {
  std::error_code error;
  fs::path real = fs::canonical(folder, error);
  if (error || !fs::is_directory(real, error)) {
    throw std::invalid_argument("demonstration_folders: '" + folder.string() +
                                "' is no folder, must be one");
  }
  return real;
}

}  // namespace

DemonstrationFolders::DemonstrationFolders(const std::string& first, const std::string& others)
    : first_(fs::path(first).parent_path()) {
  if (first_.empty()) first_ = ".";
  std::error_code error;
  folders_.push_back(fs::weakly_canonical(first_, error));
  std::istringstream list(others);
  for (std::string folder; std::getline(list, folder, ':');) {
    if (!folder.empty()) folders_.push_back(real_folder(folder));
  }
}

std::string DemonstrationFolders::resolve(const std::string& name) const {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(first_ / name, error);
  if (error || name.find('\0') != std::string::npos) {
    throw std::invalid_argument("'" + shown(name) + "' cannot be a file: " + error.message());
  }
  const bool allowed = std::any_of(folders_.begin(), folders_.end(),
                                   [&real](const auto& folder) { return is_inside(real, folder); });
  if (!allowed) {
    std::string list;
    for (const fs::path& folder : folders_) list += (list.empty() ? "" : ", ") + folder.string();
    throw std::invalid_argument("'" + shown(name) + "' is outside demonstration_folders: " + list);
  }
  return real.string();
}

}  // namespace elte_planner
