// SPDX-License-Identifier: BSD-3-Clause
#include "platform_sim/platform_profile.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <prf_core/quoted.hpp>
#include <prf_core/readable_file.hpp>
#include <prf_core/require.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "motion_families.hpp"
#include "packaged_profiles.hpp"
#include "profile_reach.hpp"

namespace platform_sim {
namespace {

constexpr double kShortestLag = 0.01;       // s
constexpr double kLongestLag = 10.0;        // s
constexpr double kLargestAmplitude = 10.0;  // m or rad, before the bounds of bounds_of()
constexpr double kFastestRate = 200.0;      // rad/s
constexpr double kLargestPhase = 1000.0;    // rad
constexpr std::size_t kMostSines = 1000;    // per axis

// Largest magnitudes that are let through; units as in Reach.
using Bounds = Reach;

Bounds bounds_of(std::size_t axis, bool carries_base) {
  const bool is_linear = axis < 3;
  if (carries_base) return is_linear ? Bounds{1.0, 10.0, 150.0} : Bounds{0.5, 5.0, 50.0};
  return is_linear ? Bounds{0.1, 0.5, 2.5} : Bounds{0.18, 0.7, 3.0};
}

void require_at_most(const std::string& what, double value, double bound, const std::string& unit) {
  std::ostringstream most;
  most << "at most " << bound << " " << unit;
  prf_core::require(value <= bound, what, value, most.str());
}

void require_within(std::size_t axis, const Bounds& bounds, const Bounds& reached) {
  const std::string name = kAxisNames[axis];
  const bool is_linear = axis < 3;
  require_at_most(name + " amplitude", reached.value, bounds.value, is_linear ? "m" : "rad");
  require_at_most(name + " velocity", reached.velocity, bounds.velocity,
                  is_linear ? "m/s" : "rad/s");
  require_at_most(name + " acceleration", reached.acceleration, bounds.acceleration,
                  is_linear ? "m/s2" : "rad/s2");
}

// The sum of the amplitudes is cheap; the truth is looked for where the sum is too much.
Reach true_reach_of(const AxisProfile& axis, const Bounds& bounds) {
  const Reach most = reach_of(axis);
  const bool is_surely_within = most.value <= bounds.value && most.velocity <= bounds.velocity &&
                                most.acceleration <= bounds.acceleration;
  return is_surely_within || axis.sines.size() == 1 ? most : sampled_reach_of(axis);
}

void require_sound(const std::string& name, const AxisProfile& axis) {
  if (axis.lag != 0.0) {
    prf_core::require_between(name + " lag", axis.lag, kShortestLag, kLongestLag, "s");
  }
  prf_core::require(axis.sines.size() <= kMostSines, name + " sines", axis.sines.size(),
                    "at most " + std::to_string(kMostSines));
  for (const Sine& sine : axis.sines) {
    prf_core::require_between(name + " amplitude", sine.amplitude, -kLargestAmplitude,
                              kLargestAmplitude);
    prf_core::require_between(name + " phase", sine.phase, -kLargestPhase, kLargestPhase, "rad");
    prf_core::require_between(name + " rate", sine.rate, 0.0, kFastestRate, "rad/s");
  }
}

void refuse_unknown(const YAML::Node& map, const std::string& where,
                    const std::set<std::string>& known) {
  if (!map.IsMap()) {
    throw std::invalid_argument(where + " is " + prf_core::quoted(YAML::Dump(map)) +
                                ", must be a map of keys, see config/profiles");
  }
  for (const auto& entry : map) {
    const auto key = entry.first.as<std::string>();
    if (known.count(key) == 0)
      throw std::invalid_argument(where + " knows no key '" + key + "', see config/profiles");
  }
}

double number_at(const YAML::Node& map, const std::string& where, const std::string& key) {
  if (!map[key]) {
    throw std::invalid_argument(where + " lacks " + key + ", must have it, see config/profiles");
  }
  try {
    return map[key].as<double>();
  } catch (const YAML::Exception&) {
    throw std::invalid_argument(where + " " + key + " is " +
                                prf_core::quoted(YAML::Dump(map[key])) + ", must be a number");
  }
}

AxisProfile read_axis(const YAML::Node& node, const std::string& name) {
  refuse_unknown(node, name, {"lag", "sines"});
  AxisProfile axis;
  if (node["lag"]) axis.lag = number_at(node, name, "lag");
  if (!node["sines"] || !node["sines"].IsSequence()) {
    throw std::invalid_argument(name + " has no list `sines`, must have one, see config/profiles");
  }
  for (const YAML::Node& sine : node["sines"]) {
    const std::string where = name + " sine";
    refuse_unknown(sine, where, {"amplitude", "rate", "phase"});
    axis.sines.push_back({number_at(sine, where, "amplitude"), number_at(sine, where, "rate"),
                          number_at(sine, where, "phase")});
  }
  return axis;
}

PlatformProfile read_yaml(const YAML::Node& file) {
  std::set<std::string> known(kAxisNames.begin(), kAxisNames.end());
  known.insert("base");
  refuse_unknown(file, "the file", known);
  PlatformProfile profile;
  for (std::size_t i = 0; i < kAxisNames.size(); ++i) {
    if (file[kAxisNames[i]]) profile.axes[i] = read_axis(file[kAxisNames[i]], kAxisNames[i]);
  }
  if (file["base"]) {
    const auto base = file["base"].as<std::string>();
    if (base != "free" && base != "carried") {
      throw std::invalid_argument("base = " + prf_core::quoted(base) + ", must be free or carried");
    }
    profile.carries_base = base == "carried";
  }
  return profile;
}

PlatformProfile read_yaml_file(const std::string& path) {
  prf_core::require_readable_file(path);
  return read_yaml(YAML::LoadFile(path));
}

PlatformProfile read_csv(const std::string& path) {
  PlatformProfile profile;
  profile.recording.emplace(path);
  std::set<std::string> seen;
  for (const std::string& column : profile.recording->columns()) {
    if (std::find(kAxisNames.begin(), kAxisNames.end(), column) == kAxisNames.end() ||
        !seen.insert(column).second) {
      throw std::invalid_argument("column " + prf_core::quoted(column) +
                                  ", must be one of surge, sway, heave, roll, pitch, yaw, once");
    }
  }
  return profile;
}

bool ends_in(const std::string& text, const std::string& ending) {
  return text.size() > ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

std::optional<PlatformProfile> preset_of(const std::string& name) {
  if (name == "none") return PlatformProfile{};
  for (const PackagedProfile& profile : packaged_profiles()) {
    if (profile.name == name) return read_yaml(YAML::Load(profile.text));
  }
  return std::nullopt;
}

std::string joined(const std::vector<std::string>& names, const std::string& ending = "") {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name + ending;
  return text;
}

}  // namespace

void PlatformProfile::validate() const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    require_sound(kAxisNames[i], axes[i]);
    const Bounds bounds = bounds_of(i, carries_base);
    require_within(i, bounds, true_reach_of(axes[i], bounds));
  }
  if (!recording) return;
  const RecordedMotion::Extremes most = recording->extremes();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto& columns = recording->columns();
    const auto found = std::find(columns.begin(), columns.end(), kAxisNames[i]);
    if (found == columns.end()) continue;
    const Eigen::Index column = found - columns.begin();
    require_within(i, bounds_of(i, carries_base),
                   {most.value[column], most.velocity[column], most.acceleration[column]});
  }
}

const std::vector<std::string>& preset_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result{"none"};
    for (const PackagedProfile& profile : packaged_profiles()) result.emplace_back(profile.name);
    return result;
  }();
  return names;
}

PlatformProfile find_profile(const std::string& motion, std::uint64_t seed) {
  if (const auto preset = preset_of(motion)) return *preset;
  const bool is_yaml = ends_in(motion, ".yaml");
  const bool is_csv = ends_in(motion, ".csv");
  try {
    PlatformProfile profile;
    if (is_yaml || is_csv) {
      profile = is_yaml ? read_yaml_file(motion) : read_csv(motion);
    } else if (auto family = family_profile(motion, *preset_of("heavy"), seed)) {
      profile = *std::move(family);
    } else {
      throw std::invalid_argument("must be one of: " + joined(preset_names()) + ", " +
                                  joined(family_names(), ":LEVEL") + ", or a file .yaml or .csv");
    }
    profile.validate();
    return profile;
  } catch (const std::exception& error) {
    throw std::invalid_argument("motion is " + prf_core::quoted(motion) + ": " + error.what());
  }
}

}  // namespace platform_sim
