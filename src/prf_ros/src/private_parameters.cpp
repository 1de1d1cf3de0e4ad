// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/private_parameters.hpp"

#include <ros/console.h>

#include <boost/core/demangle.hpp>
#include <charconv>
#include <optional>
#include <prf_core/quoted.hpp>
#include <sstream>
#include <stdexcept>
#include <typeinfo>
#include <utility>

namespace prf_ros {
namespace {

using XmlRpc::XmlRpcValue;

bool is_number(const XmlRpcValue& value) {
  return value.getType() == XmlRpcValue::TypeInt || value.getType() == XmlRpcValue::TypeDouble;
}

double to_number(XmlRpcValue& value) {
  if (value.getType() == XmlRpcValue::TypeInt) return static_cast<int>(value);
  return static_cast<double>(value);
}

// What a person who wrote 3e-4 sees is a number.
bool looks_like_a_number(const std::string& text) {
  const char* const begin = text.data() + (text.rfind('+', 0) == 0 ? 1 : 0);
  const char* const end = text.data() + text.size();
  double number = 0.0;
  const auto [stopped, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stopped == end;
}

// The value, and what a text that looks like something else lacks.
std::string shown(const XmlRpcValue& value) {
  std::ostringstream text;
  if (value.getType() != XmlRpcValue::TypeString) {
    value.write(text);
    return text.str();
  }
  const std::string& word = static_cast<const std::string&>(value);
  return prf_core::quoted(word) +
         (looks_like_a_number(word)
              ? " (a text: YAML 1.1, which ROS reads, wants a dot in a number "
                "with an exponent, as in 3.0e-4, and no quotation marks)"
              : "");
}

std::string type_name(const std::exception& error) {
  return boost::core::demangle(typeid(error).name());
}

std::string element(const std::string& key, int index) {
  return key + "[" + std::to_string(index) + "]";
}

XmlRpcValue fetch(const ros::NodeHandle& handle) {
  XmlRpcValue values;
  handle.getParam(handle.getNamespace(), values);
  if (values.getType() != XmlRpcValue::TypeStruct) {
    throw std::invalid_argument(
        "no parameters in " + handle.getNamespace() +
        ", the node's configuration must be loaded there: start it by its launch file");
  }
  return values;
}

}  // namespace

PrivateParameters::PrivateParameters(const ros::NodeHandle& private_handle)
    : PrivateParameters(fetch(private_handle)) {}

PrivateParameters::PrivateParameters(const XmlRpcValue& values) : PrivateParameters(values, "") {}

PrivateParameters::PrivateParameters(const XmlRpcValue& values, std::string prefix)
    : values_(values), prefix_(std::move(prefix)) {}

void PrivateParameters::refuse(const std::string& key, const XmlRpcValue& value,
                               const std::string& must) const {
  throw std::invalid_argument(prefix_ + key + " = " + shown(value) + ", must be " + must);
}

XmlRpcValue& PrivateParameters::at(const std::string& key) {
  if (!values_.hasMember(key)) {
    throw std::invalid_argument(prefix_ + key + " is missing, it is required");
  }
  read_.insert(key);
  return values_[key];
}

double PrivateParameters::number(const std::string& key) {
  XmlRpcValue& value = at(key);
  if (!is_number(value)) refuse(key, value, "a number");
  return to_number(value);
}

int PrivateParameters::integer(const std::string& key) {
  XmlRpcValue& value = at(key);
  if (value.getType() != XmlRpcValue::TypeInt) refuse(key, value, "an integer");
  return static_cast<int>(value);
}

bool PrivateParameters::flag(const std::string& key) {
  XmlRpcValue& value = at(key);
  if (value.getType() != XmlRpcValue::TypeBoolean) refuse(key, value, "true or false");
  return static_cast<bool>(value);
}

std::string PrivateParameters::text(const std::string& key) {
  XmlRpcValue& value = at(key);
  if (value.getType() != XmlRpcValue::TypeString) refuse(key, value, "a string");
  return static_cast<std::string>(value);
}

XmlRpcValue& PrivateParameters::list(const std::string& key, const std::string& must) {
  XmlRpcValue& value = at(key);
  if (value.getType() != XmlRpcValue::TypeArray) refuse(key, value, must);
  return value;
}

std::vector<double> PrivateParameters::numbers(const std::string& key) {
  XmlRpcValue& value = list(key, "a list of numbers");
  std::vector<double> result;
  for (int i = 0; i < value.size(); ++i) {
    if (!is_number(value[i])) refuse(element(key, i), value[i], "a number");
    result.push_back(to_number(value[i]));
  }
  return result;
}

std::vector<double> PrivateParameters::numbers(const std::string& key, int count) {
  const std::string must = "a list of " + std::to_string(count) + " numbers";
  if (list(key, must).size() != count) refuse(key, values_[key], must);
  return numbers(key);
}

std::vector<int> PrivateParameters::integers(const std::string& key) {
  XmlRpcValue& value = list(key, "a list of integers");
  std::vector<int> result;
  for (int i = 0; i < value.size(); ++i) {
    if (value[i].getType() != XmlRpcValue::TypeInt) refuse(element(key, i), value[i], "an integer");
    result.push_back(static_cast<int>(value[i]));
  }
  return result;
}

PrivateParameters PrivateParameters::section(const std::string& key) {
  const XmlRpcValue& value = at(key);
  if (value.getType() != XmlRpcValue::TypeStruct) refuse(key, value, "a block of parameters");
  return {value, prefix_ + key + "/"};
}

void PrivateParameters::refuse_unknown() const {
  for (auto entry = values_.begin(); entry != values_.end(); ++entry) {
    if (read_.count(entry->first) == 0 && entry->first.rfind("__", 0) != 0) {
      refuse(entry->first, entry->second, "absent: this node has no such parameter");
    }
  }
}

int run(const std::function<void()>& node_main) {
  // With its last handle ROS shuts down, and the log with it: this one outlives node_main's.
  std::optional<ros::NodeHandle> handle;
  if (ros::isInitialized()) handle.emplace();
  try {
    node_main();
    return 0;
  } catch (const std::invalid_argument& error) {
    ROS_FATAL("parameter refused: %s", error.what());
    return 2;
  } catch (const std::exception& error) {
    ROS_FATAL(
        "ended by an error that nothing handles, a defect; please report it with this line: %s: %s",
        type_name(error).c_str(), prf_core::quoted(error.what()).c_str());
  } catch (...) {
    ROS_FATAL(
        "ended by an error that nothing handles, of unknown type, a defect; please report it with "
        "the lines above");
  }
  return 3;
}

}  // namespace prf_ros
