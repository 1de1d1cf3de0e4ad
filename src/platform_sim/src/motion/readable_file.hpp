// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace platform_sim {

/// Throws std::invalid_argument unless the path is a file of at most 100 MB: neither a folder nor a
/// stream that never ends.
inline void require_readable_file(const std::string& path) {
  constexpr std::uintmax_t kLargest = 100'000'000;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw std::invalid_argument(path + " cannot be read, must be a file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > kLargest) {
    throw std::invalid_argument(path + " is too large, must be at most 100 MB");
  }
}

}  // namespace platform_sim
