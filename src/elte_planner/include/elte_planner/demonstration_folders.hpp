// SPDX-License-Identifier: BSD-3-Clause
//
// Where files that a message names may lie: whoever can send a message must not have any file of
// this machine opened and quoted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace elte_planner {

class DemonstrationFolders {
 public:
  // The folder of `first` always counts; names that are not absolute are taken from there.
  // `others`: more folders, separated by ':', which may be empty. Throws std::invalid_argument for
  // one of them that does not exist.
  explicit DemonstrationFolders(const std::string& first, const std::string& others = "");

  // The real path of the file that `name` means, with links and '..' resolved; the file need not
  // exist. Throws std::invalid_argument when it is not inside one of the folders.
  [[nodiscard]] std::string resolve(const std::string& name) const;

 private:
  std::filesystem::path first_;  // as given: what names are taken from
  std::vector<std::filesystem::path> folders_;
};

}  // namespace elte_planner
