// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/reconfigurable.hpp"

#include <dynamic_reconfigure/ConfigDescription.h>

#include <limits>
#include <prf_core/require.hpp>
#include <stdexcept>

namespace prf_ros {
namespace {

constexpr const char* kGroup = "Default";

[[noreturn]] void refuse_unknown(const std::string& name) {
  throw std::invalid_argument(name + " cannot be changed while the node runs");
}

template <typename Items>
void refuse_all(const Items& items) {
  if (!items.empty()) refuse_unknown(items.front().name);
}

}  // namespace

ReconfigurableParams::ReconfigurableParams(const ros::NodeHandle& private_handle,
                                           const std::vector<Parameter>& parameters,
                                           const Apply& apply)
    : handle_(private_handle), apply_(apply) {
  for (const Parameter& parameter : parameters) values_[parameter.name] = parameter.value;
  describe(parameters);
  updates_ = handle_.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true);
  updates_.publish(config());
  service_ = handle_.advertiseService<Request, Response>(
      "set_parameters",
      [this](Request& request, Response& response) { return change(request, response); });
}

// The caller of the service gets the text of an exception as its error.
bool ReconfigurableParams::change(const Request& request, Response& response) {
  try {
    const Values requested = requested_values(request.config);
    apply_(requested);
    values_ = requested;
  } catch (const std::invalid_argument& error) {
    ROS_WARN("change of parameters refused: %s", error.what());
    throw;
  }
  for (const auto& number : request.config.doubles) {
    handle_.setParam(number.name, number.value);
    ROS_INFO("%s is now %g", number.name.c_str(), number.value);
  }
  response.config = config();
  updates_.publish(response.config);
  return true;
}

ReconfigurableParams::Values ReconfigurableParams::requested_values(
    const dynamic_reconfigure::Config& config) const {
  refuse_all(config.bools);
  refuse_all(config.ints);
  refuse_all(config.strs);
  Values requested = values_;
  for (const auto& number : config.doubles) {
    const auto found = requested.find(number.name);
    if (found == requested.end()) refuse_unknown(number.name);
    prf_core::require_finite(number.name, number.value);
    found->second = number.value;
  }
  return requested;
}

dynamic_reconfigure::Config ReconfigurableParams::config() const {
  dynamic_reconfigure::Config config;
  for (const auto& [name, value] : values_) {
    config.doubles.emplace_back();
    config.doubles.back().name = name;
    config.doubles.back().value = value;
  }
  config.groups.resize(1);
  config.groups[0].name = kGroup;
  config.groups[0].state = true;
  return config;
}

void ReconfigurableParams::describe(const std::vector<Parameter>& parameters) {
  dynamic_reconfigure::ConfigDescription description;
  description.groups.resize(1);
  description.groups[0].name = kGroup;
  for (const Parameter& parameter : parameters) {
    dynamic_reconfigure::ParamDescription described;
    described.name = parameter.name;
    described.type = "double";
    described.description = parameter.meaning;
    description.groups[0].parameters.push_back(described);
  }
  description.dflt = description.min = description.max = config();
  for (auto& number : description.min.doubles) number.value = std::numeric_limits<double>::lowest();
  for (auto& number : description.max.doubles) number.value = std::numeric_limits<double>::max();
  descriptions_ =
      handle_.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true);
  descriptions_.publish(description);
}

}  // namespace prf_ros
