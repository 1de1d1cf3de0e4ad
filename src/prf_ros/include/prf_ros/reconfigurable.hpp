// SPDX-License-Identifier: BSD-3-Clause
// Parameters that a person may change while a node runs, over the protocol of dynamic_reconfigure
// (dynparam, rqt_reconfigure). A change takes effect as a whole, between two callbacks of the node,
// or is refused as a whole with the reason; values are never clipped. A change is refused when
// `apply` throws, and when it has an unknown name, a type other than double or a value that is not
// finite. All other parameters of the node stay as they were at its start.
//
//   ReconfigurableParams reconfigurable(
//       ros::NodeHandle("~"), {{"gain", 1.0, "what it does, unit"}},
//       [&](const ReconfigurableParams::Values& values) { core.tune(values.at("gain")); });
//
// The values in force are latched on ~parameter_updates. A changed value is also written to the
// parameter server: a node that is respawned begins with it, until a launch file loads its own
// value again.
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace prf_ros {

class ReconfigurableParams {
 public:
  struct Parameter {
    std::string name;
    double value;  // at the start
    std::string meaning;
  };
  using Values = std::map<std::string, double>;  // of all reconfigurable parameters, by name
  using Apply = std::function<void(const Values&)>;

  // `apply` is called with each change, not at the start. To refuse a change it must throw
  // std::invalid_argument and must have changed nothing.
  ReconfigurableParams(const ros::NodeHandle& private_handle,
                       const std::vector<Parameter>& parameters, const Apply& apply);

 private:
  using Request = dynamic_reconfigure::Reconfigure::Request;
  using Response = dynamic_reconfigure::Reconfigure::Response;

  bool change(const Request& request, Response& response);
  [[nodiscard]] Values requested_values(const dynamic_reconfigure::Config& config) const;
  [[nodiscard]] dynamic_reconfigure::Config config() const;
  void describe(const std::vector<Parameter>& parameters);

  ros::NodeHandle handle_;
  Apply apply_;
  Values values_;
  ros::Publisher descriptions_;
  ros::Publisher updates_;
  ros::ServiceServer service_;
};

}  // namespace prf_ros
