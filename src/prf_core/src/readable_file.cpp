// SPDX-License-Identifier: BSD-3-Clause
#include "prf_core/readable_file.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace prf_core {
namespace {

constexpr std::uintmax_t kMaxBytes = 200'000'000;

}  // namespace

void require_readable_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw std::invalid_argument(path + ": there is no such file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw std::invalid_argument(path + ": cannot be read, must be a file");
  }
  if (std::filesystem::file_size(path, error) > kMaxBytes || error) {
    throw std::invalid_argument(path + ": is too large, must be at most 200 MB");
  }
  if (!std::ifstream(path))
    throw std::invalid_argument(path + ": cannot be read: may this user read it?");
}

}  // namespace prf_core
