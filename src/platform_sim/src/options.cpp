// SPDX-License-Identifier: BSD-3-Clause
#include "options.hpp"

#include <cmath>
#include <stdexcept>

namespace platform_sim {
namespace {

// The whole text read by `convert`, as std::stod and std::stol do.
template <class Convert>
auto parse(const std::string& name, const std::string& text, const char* must, Convert convert) {
  std::size_t used = 0;
  decltype(convert(text, &used)) value = 0;
  try {
    value = convert(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (text.empty() || used != text.size()) {
    throw std::invalid_argument("--" + name + " = '" + text + "', must be " + must);
  }
  return value;
}

}  // namespace

Options::Options(int argc, char** argv) {
  for (int i = 1; i < argc; i += 2) {
    const std::string word = argv[i];
    if (word.rfind("--", 0) != 0) {
      throw std::invalid_argument("'" + word + "' is not an option --name");
    }
    if (i + 1 == argc) throw std::invalid_argument(word + " has no value");
    if (!values_.emplace(word.substr(2), argv[i + 1]).second) {
      throw std::invalid_argument(word + " is given twice");
    }
  }
}

bool Options::has(const std::string& name) const { return values_.count(name) > 0; }

std::string Options::text(const std::string& name) {
  if (!has(name)) throw std::invalid_argument("--" + name + " is missing");
  return text(name, "");
}

std::string Options::text(const std::string& name, const std::string& unless_given) {
  read_.insert(name);
  const auto value = values_.find(name);
  return value == values_.end() ? unless_given : value->second;
}

double Options::number(const std::string& name, double unless_given) {
  if (read_.insert(name); !has(name)) return unless_given;
  const double value =
      parse(name, values_.at(name), "a number",
            [](const std::string& word, std::size_t* used) { return std::stod(word, used); });
  if (std::isfinite(value)) return value;
  throw std::invalid_argument("--" + name + " = " + values_.at(name) + ", must be finite");
}

long Options::integer(const std::string& name, long unless_given) {
  if (read_.insert(name); !has(name)) return unless_given;
  return parse(name, values_.at(name), "a whole number",
               [](const std::string& word, std::size_t* used) { return std::stol(word, used); });
}

void Options::refuse_unknown() const {
  for (const auto& [name, value] : values_) {
    if (read_.count(name) == 0) throw std::invalid_argument("--" + name + " is unknown");
  }
}

}  // namespace platform_sim
