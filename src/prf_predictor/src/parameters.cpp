// SPDX-License-Identifier: BSD-3-Clause
#include "parameters.hpp"

#include <stdexcept>

namespace prf_predictor {
namespace {

[[noreturn]] void refuse(const std::string& name, const XmlRpc::XmlRpcValue& value,
                         const std::string& bound) {
  throw std::invalid_argument(name + " = " + value.toXml() + ", must be " + bound);
}

double to_number(const std::string& name, XmlRpc::XmlRpcValue& value) {
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) return static_cast<int>(value);
  if (value.getType() != XmlRpc::XmlRpcValue::TypeDouble) refuse(name, value, "a number");
  return static_cast<double>(value);
}

}  // namespace

Parameters::Parameters(const ros::NodeHandle& private_node) {
  private_node.getParam(private_node.getNamespace(), values_);
  if (values_.getType() != XmlRpc::XmlRpcValue::TypeStruct) values_.clear();
}

XmlRpc::XmlRpcValue& Parameters::at(const std::string& name) {
  known_.insert(name);
  if (!values_.hasMember(name)) throw std::invalid_argument(name + " is missing, must be given");
  return values_[name];
}

double Parameters::number(const std::string& name) { return to_number(name, at(name)); }

int Parameters::integer(const std::string& name) {
  XmlRpc::XmlRpcValue& value = at(name);
  if (value.getType() != XmlRpc::XmlRpcValue::TypeInt) refuse(name, value, "an integer");
  return static_cast<int>(value);
}

std::string Parameters::text(const std::string& name) {
  XmlRpc::XmlRpcValue& value = at(name);
  if (value.getType() != XmlRpc::XmlRpcValue::TypeString) refuse(name, value, "a string");
  return static_cast<std::string>(value);
}

std::vector<double> Parameters::numbers(const std::string& name) {
  XmlRpc::XmlRpcValue& value = at(name);
  if (value.getType() != XmlRpc::XmlRpcValue::TypeArray) refuse(name, value, "a list of numbers");
  std::vector<double> result;
  for (int i = 0; i < value.size(); ++i) result.push_back(to_number(name, value[i]));
  return result;
}

void Parameters::refuse_unknown() const {
  auto values = values_;
  for (const auto& [name, value] : values) {
    if (known_.count(name) == 0 && name.rfind("__", 0) != 0) {
      refuse(name, value, "absent: no such parameter");
    }
  }
}

}  // namespace prf_predictor
