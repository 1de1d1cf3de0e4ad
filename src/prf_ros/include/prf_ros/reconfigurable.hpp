// SPDX-License-Identifier: BSD-3-Clause
// Numbers that a person may change while a node runs, over dynamic_reconfigure's protocol
// (dynparam, rqt_reconfigure): applied whole, between two callbacks of the node, or refused whole
// with the reason. Nothing is clipped. Beside them the node's parameters stay as they were at its
// start.
//
//   ReconfigurableParams reconfigurable(ros::NodeHandle("~"), {{"gain", 1.0, "what it does,
//   unit"}},
//                       [&](const ReconfigurableParams::Values& values) {
//                       core.tune(values.at("gain"));
//                       });
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
  struct Number {
    std::string name;
    double value;  // at the start
    std::string meaning;
  };
  using Values = std::map<std::string, double>;  // of all numbers
  using Apply = std::function<void(const Values&)>;

  // `apply` throws std::invalid_argument to refuse; then nothing may have changed.
  ReconfigurableParams(const ros::NodeHandle& private_handle, const std::vector<Number>& numbers,
                       const Apply& apply);

 private:
  using Request = dynamic_reconfigure::Reconfigure::Request;
  using Response = dynamic_reconfigure::Reconfigure::Response;

  bool change(const Request& request, Response& response);
  [[nodiscard]] Values changed(const dynamic_reconfigure::Config& config) const;
  [[nodiscard]] dynamic_reconfigure::Config config() const;
  void describe(const std::vector<Number>& numbers);

  ros::NodeHandle handle_;
  Apply apply_;
  Values values_;
  ros::Publisher descriptions_;
  ros::Publisher updates_;
  ros::ServiceServer service_;
};

}  // namespace prf_ros
