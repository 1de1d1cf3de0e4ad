// SPDX-License-Identifier: BSD-3-Clause
#include "prf_ros/input_monitor.hpp"

#include <algorithm>
#include <chrono>
#include <prf_core/quoted.hpp>
#include <prf_core/require.hpp>

namespace prf_ros {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using Level = InputHealth::Level;

constexpr double kCheckPeriod = 1.0;  // s
constexpr double kLogPeriod = 5.0;    // s, of a line that says the same again

double wall_time() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

// As the master knows them; "none" also when it does not answer.
std::string publishers_of(const std::string& topic) {
  XmlRpc::XmlRpcValue request(ros::this_node::getName());
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  std::string names;
  if (!ros::master::execute("getSystemState", request, response, state, false)) return "none";
  for (int i = 0; i < state[0].size(); ++i) {
    if (static_cast<std::string>(state[0][i][0]) != topic) continue;
    for (int k = 0; k < state[0][i][1].size(); ++k) {
      names += (names.empty() ? "" : ", ") + static_cast<std::string>(state[0][i][1][k]);
    }
  }
  return names.empty() ? "none" : names;
}

}  // namespace

InputMonitor::InputMonitor(const ros::NodeHandle& node, diagnostic_updater::Updater* updater)
    : node_(node), updater_(updater) {
  timer_ = node_.createWallTimer(ros::WallDuration(kCheckPeriod),
                                 [this](const ros::WallTimerEvent&) { check(); });
}

InputHealth& InputMonitor::add(const InputExpectation& expected) {
  return inputs_.emplace_back(expected, wall_time()).health;
}

// A bag may have lost the name of the publisher: then it counts as a nameless one.
void InputMonitor::note(InputHealth& health, const boost::shared_ptr<ros::M_string>& connection,
                        std::optional<double> stamp) {
  std::string name;
  if (connection && connection->count("callerid") > 0) name = connection->at("callerid");
  const std::string line = health.receive(name, stamp, wall_time());
  if (!line.empty()) ROS_WARN("%s", line.c_str());
}

void InputMonitor::drop(const std::string& topic, const std::string& reason) {
  const auto input = std::find_if(inputs_.begin(), inputs_.end(), [&](const Input& one) {
    return one.health.expected().topic == topic;
  });
  prf_core::require(input != inputs_.end(), "topic", topic, "one that is subscribed here");
  const std::string line = input->health.drop(reason, wall_time());
  if (!line.empty()) ROS_WARN("%s", line.c_str());
}

void InputMonitor::check() {
  const double now = wall_time();
  bool is_well = true;
  for (Input& input : inputs_) {
    const InputHealth::Report report = input.health.report(now);
    is_well = is_well && report.level == Level::kOk;
    if (!report.to_log || now - input.logged < kLogPeriod) continue;
    input.logged = now;
    const std::string topic = node_.resolveName(input.health.expected().topic);
    ROS_WARN("%s; publishers: %s", report.text.c_str(), publishers_of(topic).c_str());
  }
  if (is_well) {
    updater_->update();
  } else {
    updater_->force_update();
  }
}

void InputMonitor::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const double now = wall_time();
  for (const Input& input : inputs_) {
    const InputHealth& health = input.health;
    const InputHealth::Report report = health.report(now);
    if (report.level != Level::kOk) {
      const bool is_error = report.level == Level::kError;
      status.mergeSummary(is_error ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN, report.text);
    }
    const std::string& topic = health.expected().topic;
    status.add(topic + " received", health.received());
    if (health.rate()) status.add(topic + " rate by stamps [Hz]", *health.rate());
    for (const auto& [reason, count] : health.drops()) {
      status.add(topic + " dropped: " + reason, count);
    }
  }
}

}  // namespace prf_ros
