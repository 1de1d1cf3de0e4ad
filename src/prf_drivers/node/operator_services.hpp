// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_client.h>
#include <ros/service_server.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <optional>
#include <prf_ros/input_monitor.hpp>
#include <string>
#include <vector>

#include "params.hpp"
#include "prf_drivers/operator_gate.hpp"

namespace prf_drivers {

// What a person has in hand: ~enable (std_msgs/Bool), ~speed (std_msgs/Float64, 0 to 1), ~hold
// (std_srvs/SetBool), ~stop and ~reset (std_srvs/Trigger), which call the driver's own services,
// too, and ~status (std_msgs/Int8).
class OperatorServices {
 public:
  // `changed` is called after each of them, `reset` at each ~reset.
  OperatorServices(prf_ros::InputMonitor& inputs, const AdapterNodeParams& params,
                   std::function<void()> changed, std::function<void()> reset);

  // Why the arm must not move; empty: it may.
  [[nodiscard]] std::string veto() const;
  // Share of the velocity limits.
  [[nodiscard]] double speed() const { return speed_; }

  void tell(MotionCode code);

 private:
  bool on_stop(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_hold(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  [[nodiscard]] std::string call_driver(bool stop) const;

  Driver driver_;
  OperatorGate gate_;
  std::function<void()> changed_, reset_;
  double speed_ = 1.0;
  ros::Publisher status_;
  std::vector<ros::ServiceServer> services_;
  std::optional<MotionCode> told_;
};

}  // namespace prf_drivers
