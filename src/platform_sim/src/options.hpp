// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>

namespace platform_sim {

/// Command line of words `--name value`. A caller's mistake is a std::invalid_argument that names
/// the option, its value and what it must be.
class Options {
 public:
  Options(int argc, char** argv);

  [[nodiscard]] bool has(const std::string& name) const;
  [[nodiscard]] std::string text(const std::string& name);  // required
  [[nodiscard]] std::string text(const std::string& name, const std::string& unless_given);
  [[nodiscard]] double number(const std::string& name, double unless_given);
  [[nodiscard]] long integer(const std::string& name, long unless_given);

  /// To be called once everything has been read.
  void refuse_unknown() const;

 private:
  std::map<std::string, std::string> values_;
  std::set<std::string> read_;
};

}  // namespace platform_sim
