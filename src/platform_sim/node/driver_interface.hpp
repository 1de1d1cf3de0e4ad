// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>

#include <functional>
#include <optional>
#include <prf_ros/driver_messages.hpp>
#include <prf_ros/private_parameters.hpp>
#include <prf_ros/wall_throttle.hpp>
#include <string>
#include <vector>

#include "platform_sim/driver_model.hpp"
#include "platform_sim/world.hpp"

namespace platform_sim {

// What the simulated driver is called and how it speaks: the block `driver` of prf_drivers' files.
struct DriverNames {
  std::string speaks;
  std::string command_topic;
  std::string state_topic;
  std::string stop_service;
  std::string start_service;
  double period = 0.0;  // s, of its joint states
};

// Throws std::invalid_argument with name, value and bound.
[[nodiscard]] DriverNames load_driver_names(prf_ros::PrivateParameters values);

// The topics and services of the arm's driver, with its types and units, in place of joint_command
// and joint_states. The legs have joint states of their own, at 25 Hz.
class DriverInterface {
 public:
  // `heard` is called for each message to the driver, before it is taken or refused.
  // `joints` of the arm, in the driver's order.
  DriverInterface(ros::NodeHandle& node, const DriverNames& names,
                  const std::vector<std::string>& joints, std::function<void()> heard);

  // What came since the last call, in order.
  [[nodiscard]] std::vector<DriverPoint> take();
  // Whether the driver was stopped since the last call, so that the arm must come to rest.
  [[nodiscard]] bool take_halt();

  void publish(std::int64_t now_ms, const World& world);

  [[nodiscard]] std::string without_subscriber() const;  // empty: somebody hears the joint states
  [[nodiscard]] std::string without_publisher() const;
  [[nodiscard]] unsigned links() const;  // subscribers and publishers of the driver's topics
  [[nodiscard]] unsigned refused() const { return refused_; }

 private:
  template <typename Message>
  void listen(ros::NodeHandle& node,
              DriverPoint (*read)(const Message&, const std::vector<std::string>&));
  void offer_stop(ros::NodeHandle& node);
  void receive(const std::function<DriverPoint()>& read);

  DriverNames names_;
  std::vector<std::string> joints_;
  std::function<void()> heard_;
  ros::Subscriber commands_;
  ros::Publisher arm_states_, leg_states_;
  ros::ServiceServer stop_, start_;
  std::vector<DriverPoint> received_;
  bool stopped_ = false;
  bool halt_ = false;
  unsigned refused_ = 0;
  prf_ros::WallThrottle refusals_;
};

}  // namespace platform_sim
