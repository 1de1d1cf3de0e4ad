// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>

namespace platform_sim {

/// File with the given text that lives as long as this.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& text, const std::string& ending)
      : path_(testing::TempDir() + "platform_sim_" + std::to_string(getpid()) + "_" +
              std::to_string(++count()) + ending) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  static int& count() {
    static int files = 0;
    return files;
  }
  std::string path_;
};

/// What a std::invalid_argument out of the call says; empty if there is none.
inline std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace platform_sim
