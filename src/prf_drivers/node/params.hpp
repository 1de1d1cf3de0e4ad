// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "prf_drivers/command_adapter.hpp"
#include "prf_drivers/joint_state_joiner.hpp"
#include "prf_drivers/motion_guards.hpp"
#include "prf_drivers/operator_gate.hpp"
#include "prf_drivers/stand_in_arm.hpp"

namespace prf_drivers {

enum class Speaks { kVelocityGroup, kPositionGroup, kTrajectory, kKinova, kKortex };

// The block `driver` beside the nodes; config/<driver>.yaml says what each means. It is shared by
// adapter and joiner.
struct Driver {
  Speaks speaks = Speaks::kVelocityGroup;
  std::string command_topic;
  std::string state_topic;
  std::string stop_service;  // empty: the driver has none
  std::string start_service;
  std::vector<std::string> joints;  // in the order in which the driver takes them
  double period = 0.0;              // s, of the control ticks
};

enum class Pace {
  kTick,   // the driver gets a message when a tick is decided
  kTimer,  // and one every period exactly, whenever the ticks come
};

struct AdapterNodeParams {
  Driver driver;
  AdapterParams adapter;
  OperatorParams operators;
  GuardsParams guards;
  Pace pace = Pace::kTick;
  double horizon = 0.0;  // s, time_from_start of a trajectory's point
  bool dry_run = false;  // the driver is sent nothing: all goes to rehearsal<command_topic>
};

struct JoinerNodeParams {
  Driver driver;
  JointJoinerParams joiner;
  std::vector<std::string> other_topics;  // joint states beside the driver's
  bool fill = false;                      // ticks between messages of a driver that is slower
  double velocity_unit = 0.0;             // rad/s, what 1 means in the driver's velocities
};

struct StandInNodeParams {
  std::vector<std::string> joints;
  StandInParams stand_in;
};

// Each throws std::invalid_argument with name, value and bound.
[[nodiscard]] AdapterNodeParams load_adapter(const ros::NodeHandle& node,
                                             const ros::NodeHandle& private_node);
[[nodiscard]] JoinerNodeParams load_joiner(const ros::NodeHandle& node,
                                           const ros::NodeHandle& private_node);
[[nodiscard]] StandInNodeParams load_stand_in(const ros::NodeHandle& private_node);

}  // namespace prf_drivers
