// SPDX-License-Identifier: BSD-3-Clause
#include "params.hpp"

#include <ros/names.h>

#include <map>
#include <prf_core/require.hpp>
#include <prf_ros/private_parameters.hpp>
#include <sstream>

namespace prf_drivers {
namespace {

// From a tick until execution/progress of it is known here.
constexpr prf_core::Duration kKnownWithin = std::chrono::milliseconds(50);

// Words separated by spaces.
std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> result;
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

template <typename Value>
Value one_of(const std::string& name, const std::string& word,
             const std::map<std::string, Value>& allowed) {
  const auto found = allowed.find(word);
  std::string bound = "one of";
  for (const auto& [key, value] : allowed) bound += " " + key;
  prf_core::require(found != allowed.end(), name, "'" + word + "'", bound);
  return found->second;
}

void require_topic(const std::string& name, const std::string& topic) {
  std::string error;
  prf_core::require(!topic.empty() && ros::names::validate(topic, error), name, "'" + topic + "'",
                    "a name of ROS");
}

Driver load_driver(const ros::NodeHandle& node) {
  prf_ros::PrivateParameters values{ros::NodeHandle(node, "driver")};
  Driver driver;
  driver.speaks = one_of<Speaks>("driver/speaks", values.text("speaks"),
                                 {{"velocity_group", Speaks::kVelocityGroup},
                                  {"position_group", Speaks::kPositionGroup},
                                  {"trajectory", Speaks::kTrajectory},
                                  {"kinova", Speaks::kKinova},
                                  {"kortex", Speaks::kKortex}});
  driver.command_topic = values.text("command_topic");
  driver.state_topic = values.text("state_topic");
  driver.stop_service = values.text("stop_service");
  driver.start_service = values.text("start_service");
  driver.joints = words(values.text("joints"));
  driver.period = values.number("period");
  values.refuse_unknown();
  require_topic("driver/command_topic", driver.command_topic);
  require_topic("driver/state_topic", driver.state_topic);
  prf_core::require(!driver.joints.empty(), "driver/joints", "''", "names separated by spaces");
  prf_core::require(driver.speaks != Speaks::kKinova || driver.joints.size() <= 7, "driver/joints",
                    driver.joints.size(), "at most 7 for kinova");
  return driver;
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// The block `guards` beside the nodes; config/guards has what each means.
GuardsParams load_guards(const ros::NodeHandle& node, const Driver& driver) {
  prf_ros::PrivateParameters values{ros::NodeHandle(node, "guards")};
  GuardsParams guards;
  guards.joints = driver.joints;
  guards.start.ready = vector_of(values.numbers("ready"));
  guards.start.distance = values.number("start_distance");
  guards.start.speed = values.number("start_speed");
  guards.start.known_within = kKnownWithin;
  guards.effort.lower = vector_of(values.numbers("effort_lower"));
  guards.effort.upper = vector_of(values.numbers("effort_upper"));
  guards.effort.patience = values.number("effort_patience");
  guards.base_link = values.text("base_link");
  guards.workspace = values.numbers("workspace");
  guards.forbidden = values.numbers("forbidden");
  guards.self_collision = values.flag("self_collision");
  guards.joint_bounds = values.flag("joint_bounds");
  guards.clearance.stop_distance = values.number("stop_distance");
  guards.clearance.slow_distance = values.number("slow_distance");
  values.refuse_unknown();
  if (guards.needs_urdf()) {
    const bool given = node.getParam("robot_description", guards.urdf);
    prf_core::require(given, "robot_description", "''", "set: the guards need it");
  }
  return guards;
}

bool takes_positions(Speaks speaks) {
  return speaks == Speaks::kPositionGroup || speaks == Speaks::kTrajectory;
}

}  // namespace

AdapterNodeParams load_adapter(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  AdapterNodeParams params;
  params.driver = load_driver(node);
  params.guards = load_guards(node, params.driver);
  prf_ros::PrivateParameters values(private_node);
  params.adapter.takes =
      takes_positions(params.driver.speaks) ? Takes::kPositions : Takes::kVelocities;
  params.adapter.period = params.driver.period;
  params.adapter.delay = values.number("delay");
  params.adapter.gain = values.number("gain");
  params.adapter.command_timeout = values.number("command_timeout");
  params.adapter.max_distance = values.number("max_distance");
  params.adapter.braking = values.number("braking");
  const std::vector<double> limits =
      values.numbers("max_velocity", static_cast<int>(params.driver.joints.size()));
  params.adapter.max_velocity = vector_of(limits);
  params.pace =
      one_of<Pace>("pace", values.text("pace"), {{"tick", Pace::kTick}, {"timer", Pace::kTimer}});
  params.horizon = values.number("horizon");
  params.operators.dead_man = values.flag("dead_man");
  params.operators.enable_timeout = values.number("enable_timeout");
  params.operators.needs_check = values.flag("needs_check");
  params.dry_run = values.flag("dry_run");
  values.refuse_unknown();
  params.adapter.validate();
  params.operators.validate();
  prf_core::require_between("horizon", params.horizon, params.driver.period, 1.0, "s");
  if (params.dry_run) {
    params.driver.command_topic = ros::names::append("/rehearsal", params.driver.command_topic);
    params.driver.stop_service.clear();
    params.driver.start_service.clear();
  }
  return params;
}

StandInNodeParams load_stand_in(const ros::NodeHandle& private_node) {
  prf_ros::PrivateParameters values(private_node);
  StandInNodeParams params;
  params.joints = words(values.text("joints"));
  prf_core::require(!params.joints.empty(), "joints", "''", "names separated by spaces");
  params.stand_in.delay = values.number("delay");
  params.stand_in.max_velocity =
      vector_of(values.numbers("max_velocity", static_cast<int>(params.joints.size())));
  values.refuse_unknown();
  params.stand_in.validate();
  return params;
}

JoinerNodeParams load_joiner(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  JoinerNodeParams params;
  params.driver = load_driver(node);
  prf_ros::PrivateParameters values(private_node);
  params.other_topics = words(values.text("other_topics"));
  params.fill = values.flag("fill");
  params.velocity_unit = values.number("velocity_unit");
  params.joiner.sources = 1 + params.other_topics.size();
  params.joiner.period = params.driver.period;
  params.joiner.settle = values.number("settle");
  params.joiner.max_age = values.number("max_age");
  values.refuse_unknown();
  for (const std::string& topic : params.other_topics) require_topic("other_topics", topic);
  prf_core::require_between("velocity_unit", params.velocity_unit, 1e-3, 10.0, "rad/s");
  params.joiner.validate();
  return params;
}

}  // namespace prf_drivers
