// SPDX-License-Identifier: BSD-3-Clause
#include "prf_decision/hmm/hmm_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <initializer_list>
#include <iomanip>
#include <prf_core/readable_file.hpp>
#include <sstream>
#include <stdexcept>

namespace prf_decision {
namespace {

using Keys = std::initializer_list<const char*>;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void require_keys(const YAML::Node& map, const std::string& name, const Keys& keys,
                  const Keys& optional = {}) {
  if (!map.IsMap()) refuse(name + " is not a map of keys");
  for (const auto& entry : map) {
    const auto key = entry.first.as<std::string>();
    const auto is_key = [&](const char* one) { return key == one; };
    if (std::none_of(keys.begin(), keys.end(), is_key) &&
        std::none_of(optional.begin(), optional.end(), is_key)) {
      refuse("unknown key '" + key + "' in " + name);
    }
  }
  for (const char* key : keys) {
    if (!map[key]) refuse("missing key '" + std::string(key) + "' in " + name);
  }
}

double number(const YAML::Node& node, const std::string& name) {
  try {
    return node.as<double>();
  } catch (const YAML::Exception&) {
    refuse(name + " is " + YAML::Dump(node) + ", must be a number");
  }
}

void require_three(const YAML::Node& node, const std::string& name) {
  if (!node.IsSequence() || node.size() != kIntents) {
    refuse(name + " is " + YAML::Dump(node) + ", must be a list of 3");
  }
}

Eigen::Vector3d vector(const YAML::Node& node, const std::string& name) {
  require_three(node, name);
  Eigen::Vector3d values;
  for (std::size_t i = 0; i < 3; ++i) {
    values[static_cast<Eigen::Index>(i)] = number(node[i], name + "[" + std::to_string(i) + "]");
  }
  return values;
}

Eigen::Matrix3d matrix(const YAML::Node& node, const std::string& name) {
  require_three(node, name);
  Eigen::Matrix3d rows;
  for (std::size_t i = 0; i < 3; ++i) {
    rows.row(static_cast<Eigen::Index>(i)) =
        vector(node[i], name + "[" + std::to_string(i) + "]").transpose();
  }
  return rows;
}

LogDeviation log_deviation_of(const YAML::Node& node, const std::string& name) {
  if (!node.IsSequence() || node.size() != 2) {
    refuse(name + " is " + YAML::Dump(node) + ", must be a list of 2");
  }
  return {number(node[0], name + "[0]"), number(node[1], name + "[1]")};
}

HmmParams parse(const YAML::Node& root) {
  const Keys intents{kIntentNames[0], kIntentNames[1], kIntentNames[2]};
  require_keys(root, "the file", {"initial", "transition", "mean", "covariance"},
               {"deviation", "weight"});
  for (const char* key : {"initial", "transition", "mean", "covariance"}) {
    require_keys(root[key], key, intents);
  }
  HmmParams parameters;
  if (root["weight"]) parameters.weight = number(root["weight"], "weight");
  if (root["deviation"]) {
    require_keys(root["deviation"], "deviation", intents);
    parameters.deviation.emplace();
  }
  for (std::size_t i = 0; i < kIntents; ++i) {
    const std::string intent = kIntentNames[i];
    const auto row = static_cast<Eigen::Index>(i);
    parameters.initial[row] = number(root["initial"][intent], "initial." + intent);
    parameters.transition.row(row) =
        vector(root["transition"][intent], "transition." + intent).transpose();
    parameters.mean[i] = vector(root["mean"][intent], "mean." + intent);
    parameters.covariance[i] = matrix(root["covariance"][intent], "covariance." + intent);
    if (parameters.deviation) {
      (*parameters.deviation)[i] =
          log_deviation_of(root["deviation"][intent], "deviation." + intent);
    }
  }
  parameters.validate();
  return parameters;
}

const Eigen::IOFormat kList(17, Eigen::DontAlignCols, ", ", ", ", "", "", "[", "]");

}  // namespace

HmmParams load_hmm(const std::string& path) {
  prf_core::require_readable_file(path);
  try {
    return parse(YAML::LoadFile(path));
  } catch (const YAML::Exception& error) {
    refuse("HMM file '" + path + "': " + error.what());
  } catch (const std::invalid_argument& error) {
    refuse("HMM file '" + path + "': " + error.what());
  }
}

std::string hmm_text(const HmmParams& parameters, const std::string& comment) {
  parameters.validate();
  std::ostringstream text;
  text << std::setprecision(17);
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text << "# " << line << '\n';
  text << "\n# Probability of each state at the first forecast.\ninitial:\n";
  for (std::size_t i = 0; i < kIntents; ++i) {
    text << "  " << kIntentNames[i] << ": " << parameters.initial[static_cast<Eigen::Index>(i)]
         << '\n';
  }
  text << "\n# Row: state now. Columns: forward, pause, reverse at the next forecast.\n"
       << "transition:\n";
  for (std::size_t i = 0; i < kIntents; ++i) {
    const Eigen::RowVector3d row = parameters.transition.row(static_cast<Eigen::Index>(i));
    text << "  " << kIntentNames[i] << ": " << row.format(kList) << '\n';
  }
  text << "\n# Mean velocity, m/s.\nmean:\n";
  for (std::size_t i = 0; i < kIntents; ++i) {
    text << "  " << kIntentNames[i] << ": " << parameters.mean[i].transpose().format(kList) << '\n';
  }
  text << "\n# Covariance of the velocity, m^2/s^2, row by row.\ncovariance:\n";
  for (std::size_t i = 0; i < kIntents; ++i) {
    text << "  " << kIntentNames[i] << ":\n";
    for (Eigen::Index row = 0; row < 3; ++row) {
      const Eigen::RowVector3d values = parameters.covariance[i].row(row);
      text << "    - " << values.format(kList) << '\n';
    }
  }
  if (parameters.weight != 1) {
    text << "\n# Of an observation in the filter: successive ones are not independent.\nweight: "
         << parameters.weight << '\n';
  }
  if (!parameters.deviation) return text.str();
  text << "\n# ln(deviation of the shadow arm's hand + 0.003 m): mean and standard deviation.\n"
       << "deviation:\n";
  for (std::size_t i = 0; i < kIntents; ++i) {
    const auto& [mean, sigma] = (*parameters.deviation)[i];
    text << "  " << kIntentNames[i] << ": [" << mean << ", " << sigma << "]\n";
  }
  return text.str();
}

}  // namespace prf_decision
