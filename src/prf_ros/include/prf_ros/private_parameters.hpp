// SPDX-License-Identifier: BSD-3-Clause
// The private parameters of a node, read strictly. A missing key and a wrong type throw
// std::invalid_argument, which names the parameter, its value and what it must be. So does
// refuse_unknown() for a key that nothing has read.
//
//   PrivateParameters values(ros::NodeHandle("~"));
//   params.rate = values.number("rate");
//   values.refuse_unknown();
//
// Bounds are not checked here: the struct that holds the value checks them in its validate().
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace prf_ros {

class PrivateParameters {
 public:
  explicit PrivateParameters(const ros::NodeHandle& private_handle);
  explicit PrivateParameters(const XmlRpc::XmlRpcValue& values);  // a struct, for tests

  [[nodiscard]] double number(const std::string& key);  // also from an integer; may be NaN or inf
  [[nodiscard]] int integer(const std::string& key);    // 3, not 3.0
  [[nodiscard]] bool flag(const std::string& key);
  [[nodiscard]] std::string text(const std::string& key);
  [[nodiscard]] std::vector<double> numbers(const std::string& key);
  [[nodiscard]] std::vector<double> numbers(const std::string& key, int count);  // exactly so many
  [[nodiscard]] std::vector<int> integers(const std::string& key);
  // A block of parameters; error messages call them block/key. The caller calls refuse_unknown() of
  // the block, too: that of the whole does not look into blocks.
  [[nodiscard]] PrivateParameters section(const std::string& key);

  // To be called once everything has been read. Keys that begin with "__" are ROS's own.
  void refuse_unknown() const;

 private:
  PrivateParameters(const XmlRpc::XmlRpcValue& values, std::string prefix);

  XmlRpc::XmlRpcValue& at(const std::string& key);
  [[noreturn]] void refuse(const std::string& key, const XmlRpc::XmlRpcValue& value,
                           const std::string& must) const;
  XmlRpc::XmlRpcValue& list(const std::string& key, const std::string& must);

  XmlRpc::XmlRpcValue values_;
  std::string prefix_;  // of the keys, in error messages
  std::set<std::string> read_;
};

// Runs a node's main function and returns the exit code of the node, 0 when the function returns.
// A std::invalid_argument that it throws becomes one ROS_FATAL line and exit code 2, the code of a
// command that is called wrongly. Any other exception becomes one ROS_FATAL line that names it and
// exit code 3.
[[nodiscard]] int run(const std::function<void()>& node_main);

}  // namespace prf_ros
