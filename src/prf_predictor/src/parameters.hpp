// SPDX-License-Identifier: BSD-3-Clause
// Reads a node's private parameters: all are required, unknown ones are refused.
// Every complaint is a std::invalid_argument that names the parameter.
#pragma once

#include <ros/node_handle.h>

#include <set>
#include <string>
#include <vector>

namespace prf_predictor {

class Parameters {
 public:
  explicit Parameters(const ros::NodeHandle& private_node);

  double number(const std::string& name);
  int integer(const std::string& name);
  std::string text(const std::string& name);
  std::vector<double> numbers(const std::string& name);

  // To be called once everything has been read.
  void refuse_unknown() const;

 private:
  XmlRpc::XmlRpcValue& at(const std::string& name);

  XmlRpc::XmlRpcValue values_;
  std::set<std::string> known_;
};

}  // namespace prf_predictor
