// SPDX-License-Identifier: BSD-3-Clause
#include "node_params.hpp"

#include <XmlRpcValue.h>

#include <set>
#include <sstream>
#include <stdexcept>

namespace elte_planner {
namespace {

class PrivateNamespace {
 public:
  explicit PrivateNamespace(const ros::NodeHandle& handle) {
    handle.getParam(handle.getNamespace(), values_);
    if (values_.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
      throw std::invalid_argument("no parameters in " + handle.getNamespace() +
                                  ", load config/skill_planner.yaml there");
    }
  }

  std::string text(const std::string& key) {
    XmlRpc::XmlRpcValue& value = required(key);
    if (value.getType() != XmlRpc::XmlRpcValue::TypeString) refuse(key, value, "a string");
    return value;
  }

  bool flag(const std::string& key) {
    XmlRpc::XmlRpcValue& value = required(key);
    if (value.getType() != XmlRpc::XmlRpcValue::TypeBoolean) refuse(key, value, "true or false");
    return value;
  }

  int whole(const std::string& key) {
    XmlRpc::XmlRpcValue& value = required(key);
    if (value.getType() != XmlRpc::XmlRpcValue::TypeInt) refuse(key, value, "a whole number");
    return value;
  }

  double number(const std::string& key) {
    XmlRpc::XmlRpcValue& value = required(key);
    if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) return static_cast<int>(value);
    if (value.getType() != XmlRpc::XmlRpcValue::TypeDouble) refuse(key, value, "a number");
    return value;
  }

  void refuse_unknown() const {
    for (auto entry = values_.begin(); entry != values_.end(); ++entry) {
      const bool reserved_by_ros = entry->first.rfind("__", 0) == 0;
      if (!reserved_by_ros && known_.count(entry->first) == 0) {
        throw std::invalid_argument(entry->first + " is not a parameter of this node");
      }
    }
  }

 private:
  XmlRpc::XmlRpcValue& required(const std::string& key) {
    if (!values_.hasMember(key)) throw std::invalid_argument(key + " is missing, it is required");
    known_.insert(key);
    return values_[key];
  }

  [[noreturn]] static void refuse(const std::string& key, const XmlRpc::XmlRpcValue& value,
                                  const char* what) {
    std::ostringstream message;
    message << key << " is ";
    value.write(message);
    message << ", must be " << what;
    throw std::invalid_argument(message.str());
  }

  mutable XmlRpc::XmlRpcValue values_;
  std::set<std::string> known_;
};

}  // namespace

NodeParams load_node_params(const ros::NodeHandle& private_handle) {
  PrivateNamespace values(private_handle);
  NodeParams params;
  params.demonstration = values.text("demonstration");
  params.frame = values.text("frame");
  params.session.planner = values.text("planner");
  params.session.framework = values.flag("framework");
  params.session.nodes = values.whole("nodes");
  params.session.weights.elastic = values.number("w_elastic");
  params.session.weights.bending = values.number("w_bending");
  params.session.horizon_max = values.number("horizon_max");
  params.session.confidence = values.number("confidence");
  params.session.radius_min = values.number("radius_min");
  params.session.radius_max = values.number("radius_max");
  values.refuse_unknown();
  params.session.validate();
  if (params.demonstration.empty()) {
    throw std::invalid_argument("demonstration is '', must name a CSV file");
  }
  if (params.frame.empty()) throw std::invalid_argument("frame is '', must name a frame");
  return params;
}

}  // namespace elte_planner
