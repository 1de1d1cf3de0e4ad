// SPDX-License-Identifier: BSD-3-Clause
#include "prf_predictor/predictors.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <prf_core/require.hpp>
#include "prf_predictor/kalman_predictor.hpp"
#include "prf_predictor/periodic_predictor.hpp"
#include "prf_predictor/window_predictor.hpp"

namespace prf_predictor {

using prf_core::require;
namespace {

using Values = std::map<std::string, double>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Entry {
  std::string name;
  std::vector<std::string> parameters;
  std::function<std::unique_ptr<TargetPredictor>(const Values&)> make;
};

template <typename Model, typename Noise>
std::unique_ptr<TargetPredictor> kalman(const Noise& noise,
                                        const std::optional<SigmaPointParams>& sigma_points) {
  return std::make_unique<KalmanPredictor>(std::make_shared<Model>(noise), sigma_points);
}

template <typename Fit>
std::unique_ptr<TargetPredictor> window(const Fit& fit) {
  return std::make_unique<WindowPredictor>(std::make_shared<Fit>(fit));
}

OscillationNoise oscillation_noise(const Values& values) {
  return {values.at("acceleration_density"), values.at("centre_density"),
          values.at("frequency_density")};
}

std::vector<std::string> periodic_parameters() {
  std::vector<std::string> names;
  for (const auto& [name, member] : PeriodicParams::members()) names.push_back(name);
  return names;
}

PeriodicParams periodic_params(const Values& values) {
  PeriodicParams params;
  for (const auto& [name, member] : PeriodicParams::members()) params.*member = values.at(name);
  return params;
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> kEntries{
      {"periodic", periodic_parameters(),
       [](const Values& values) {
         return std::make_unique<PeriodicPredictor>(periodic_params(values));
       }},
      {"ukf",
       {"acceleration_density", "velocity_time_constant"},
       [](const Values& values) {
         return kalman<DecayingVelocity>(
             VelocityDecay{values.at("acceleration_density"), values.at("velocity_time_constant")},
             SigmaPointParams::textbook());
       }},
      {"paper",
       {"acceleration_density"},
       [](const Values& values) {
         return kalman<DecayingVelocity>(
             VelocityDecay{values.at("acceleration_density"), kInfinity},
             SigmaPointParams::paper());
       }},
      {"constant_velocity",
       {"acceleration_density"},
       [](const Values& values) {
         return kalman<DecayingVelocity>(
             VelocityDecay{values.at("acceleration_density"), kInfinity},
             SigmaPointParams::textbook());
       }},
      {"constant_acceleration",
       {"jerk_density"},
       [](const Values& values) {
         return kalman<ConstantAcceleration>(values.at("jerk_density"),
                                             SigmaPointParams::textbook());
       }},
      {"oscillation",
       {"acceleration_density", "centre_density", "frequency_density"},
       [](const Values& values) {
         return kalman<Oscillation>(oscillation_noise(values), SigmaPointParams::textbook());
       }},
      {"ekf",
       {"acceleration_density", "centre_density", "frequency_density"},
       [](const Values& values) {
         return kalman<Oscillation>(oscillation_noise(values), std::nullopt);
       }},
      {"autoregressive",
       {"window", "order"},
       [](const Values& values) {
         return window(Autoregressive(values.at("window"), values.at("order")));
       }},
      {"sines",
       {"window", "count"},
       [](const Values& values) { return window(Sines(values.at("window"), values.at("count"))); }},
      {"hold", {}, [](const Values& /*values*/) { return window(Hold()); }},
  };
  return kEntries;
}

const Entry& entry_of(const std::string& name) {
  const auto found = std::find_if(entries().begin(), entries().end(),
                                  [&](const Entry& entry) { return entry.name == name; });
  std::string names;
  for (const Entry& entry : entries()) names += (names.empty() ? "" : ", ") + entry.name;
  require(found != entries().end(), "predictor", name, "one of " + names);
  return *found;
}

}  // namespace

std::vector<std::string> predictor_names() {
  std::vector<std::string> names;
  for (const Entry& entry : entries()) names.push_back(entry.name);
  return names;
}

std::vector<std::string> predictor_parameters(const std::string& name) {
  return entry_of(name).parameters;
}

std::unique_ptr<TargetPredictor> make_predictor(const std::string& name, const Values& values) {
  const Entry& entry = entry_of(name);
  for (const std::string& key : entry.parameters) {
    require(values.count(key) == 1, key, "nothing", "given for the predictor " + name);
  }
  for (const auto& [key, value] : values) {
    bool is_known = false;
    for (const std::string& parameter : entry.parameters) is_known |= parameter == key;
    require(is_known, key, value, "left out: the predictor " + name + " has no such parameter");
  }
  return entry.make(values);
}

}  // namespace prf_predictor
