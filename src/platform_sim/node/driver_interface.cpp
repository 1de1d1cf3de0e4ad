// SPDX-License-Identifier: BSD-3-Clause
#include "driver_interface.hpp"

#include <ros/console.h>
#include <std_msgs/Float64MultiArray.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "conversions.hpp"

namespace platform_sim {
namespace {

constexpr std::uint32_t kQueueSize = 2000;
constexpr std::int64_t kLegPeriodMs = 40;
constexpr double kDegree = M_PI / 180.0;

using Joints = std::vector<std::string>;

void require_count(std::size_t count, const Joints& joints) {
  if (count == joints.size()) return;
  throw std::invalid_argument(std::to_string(count) + " joints, must be " +
                              std::to_string(joints.size()));
}

DriverPoint still(const Joints& joints) {
  const ArmVector zero = ArmVector::Zero(static_cast<Eigen::Index>(joints.size()));
  return {zero, zero, 0.0};
}

void require_usable(const DriverPoint& point) {
  for (Eigen::Index i = 0; i < point.positions.size(); ++i) {
    const std::string joint = " of joint " + std::to_string(i + 1);
    prf_core::require_between("position" + joint, point.positions[i], -kLargestPosition,
                              kLargestPosition, "rad");
    prf_core::require_between("velocity" + joint, point.velocities[i], -kLargestVelocity,
                              kLargestVelocity, "rad/s");
  }
  prf_core::require_between("time_from_start", point.duration, 0.0, 10.0, "s");
}

ArmVector group(const std_msgs::Float64MultiArray& message, const Joints& joints) {
  require_count(message.data.size(), joints);
  return Eigen::Map<const ArmVector>(message.data.data(), static_cast<Eigen::Index>(joints.size()));
}

DriverPoint read_velocities(const std_msgs::Float64MultiArray& message, const Joints& joints) {
  DriverPoint point = still(joints);
  point.velocities = group(message, joints);
  return point;
}

DriverPoint read_positions(const std_msgs::Float64MultiArray& message, const Joints& joints) {
  DriverPoint point = still(joints);
  point.positions = group(message, joints);
  return point;
}

DriverPoint read_trajectory(const trajectory_msgs::JointTrajectory& message, const Joints& joints) {
  const ArmCommand command = to_arm_command(message, joints);
  return {command.positions, command.velocities, message.points[0].time_from_start.toSec()};
}

DriverPoint read_kinova(const prf_ros::kinova::JointVelocity& message, const Joints& joints) {
  DriverPoint point = still(joints);
  for (Eigen::Index i = 0; i < point.velocities.size(); ++i) {
    point.velocities[i] =
        kDegree * static_cast<double>(message.joints[static_cast<std::size_t>(i)]);
  }
  return point;
}

DriverPoint read_kortex(const prf_ros::kortex::BaseJointSpeeds& message, const Joints& joints) {
  require_count(message.joint_speeds.size(), joints);
  DriverPoint point = still(joints);
  for (const prf_ros::kortex::JointSpeed& speed : message.joint_speeds) {
    prf_core::require(speed.joint_identifier < joints.size(), "joint_identifier",
                      speed.joint_identifier, "0 to " + std::to_string(joints.size() - 1));
    point.velocities[speed.joint_identifier] = static_cast<double>(speed.value);
  }
  return point;
}

// Joints begin .. begin + count of all that the world has.
sensor_msgs::JointState part_of(const ros::Time& stamp, const World& world, Eigen::Index begin,
                                Eigen::Index count) {
  const JointStates all = world.joints();
  const auto first = world.joint_names().begin() + begin;
  return to_joint_state(stamp, {first, first + count},
                        {all.positions.segment(begin, count), all.velocities.segment(begin, count),
                         all.efforts.segment(begin, count)});
}

}  // namespace

DriverNames load_driver_names(prf_ros::PrivateParameters values) {
  DriverNames names;
  names.speaks = values.text("speaks");
  names.command_topic = values.text("command_topic");
  names.state_topic = values.text("state_topic");
  names.stop_service = values.text("stop_service");
  names.start_service = values.text("start_service");
  names.period = values.number("period");
  prf_core::require_between("driver/period", names.period, 0.001, 0.1, "s");
  const double milliseconds = 1000.0 * names.period;
  prf_core::require(std::abs(milliseconds - std::round(milliseconds)) < 1e-6, "driver/period",
                    names.period, "whole milliseconds, the simulator's steps");
  return names;
}

template <typename Message>
void DriverInterface::listen(ros::NodeHandle& node,
                             DriverPoint (*read)(const Message&, const Joints&)) {
  using Pointer = boost::shared_ptr<const Message>;
  commands_ = node.subscribe<Message>(
      names_.command_topic, kQueueSize,
      [this, read](const Pointer& message) { receive([&] { return read(*message, joints_); }); },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

DriverInterface::DriverInterface(ros::NodeHandle& node, const DriverNames& names,
                                 const std::vector<std::string>& joints,
                                 std::function<void()> heard)
    : names_(names),
      joints_(joints),
      heard_(std::move(heard)),
      arm_states_(node.advertise<sensor_msgs::JointState>(names.state_topic, kQueueSize)),
      leg_states_(node.advertise<sensor_msgs::JointState>("legs/joint_states", kQueueSize)) {
  if (names.speaks == "velocity_group") {
    listen<std_msgs::Float64MultiArray>(node, read_velocities);
  } else if (names.speaks == "position_group") {
    listen<std_msgs::Float64MultiArray>(node, read_positions);
  } else if (names.speaks == "trajectory") {
    listen<trajectory_msgs::JointTrajectory>(node, read_trajectory);
  } else if (names.speaks == "kinova") {
    listen<prf_ros::kinova::JointVelocity>(node, read_kinova);
    offer_stop(node);
  } else if (names.speaks == "kortex") {
    listen<prf_ros::kortex::BaseJointSpeeds>(node, read_kortex);
  } else {
    throw std::invalid_argument("driver/speaks = '" + names.speaks +
                                "', must be one that the simulator knows");
  }
}

// As the driver of the Jaco2 does: while it is stopped it drops velocities.
void DriverInterface::offer_stop(ros::NodeHandle& node) {
  namespace kinova = prf_ros::kinova;
  using Stop = boost::function<bool(kinova::StopRequest&, kinova::StopResponse&)>;
  using Start = boost::function<bool(kinova::StartRequest&, kinova::StartResponse&)>;
  stop_ = node.advertiseService(names_.stop_service,
                                Stop([this](kinova::StopRequest&, kinova::StopResponse& response) {
                                  stopped_ = halt_ = true;
                                  response.stop_result = "stopped";
                                  return true;
                                }));
  start_ = node.advertiseService(
      names_.start_service, Start([this](kinova::StartRequest&, kinova::StartResponse& response) {
        stopped_ = false;
        response.start_result = "started";
        return true;
      }));
}

void DriverInterface::receive(const std::function<DriverPoint()>& read) {
  heard_();
  if (stopped_) return;
  try {
    const DriverPoint point = read();
    require_usable(point);
    received_.push_back(point);
  } catch (const std::invalid_argument& error) {
    ++refused_;
    if (refusals_.is_due()) {
      ROS_WARN("%s refused: %s (%u so far)", names_.command_topic.c_str(), error.what(), refused_);
    }
  }
}

std::vector<DriverPoint> DriverInterface::take() { return std::exchange(received_, {}); }

bool DriverInterface::take_halt() { return std::exchange(halt_, false); }

void DriverInterface::publish(std::int64_t now_ms, const World& world) {
  const ros::Time stamp = to_stamp(now_ms);
  const auto count = static_cast<Eigen::Index>(world.joint_names().size());
  const auto legs = count - static_cast<Eigen::Index>(joints_.size());
  if (legs > 0 && now_ms % kLegPeriodMs == 0) {
    leg_states_.publish(part_of(stamp, world, 0, legs));
  }
  arm_states_.publish(part_of(stamp, world, legs, count - legs));
}

std::string DriverInterface::without_subscriber() const {
  return arm_states_.getNumSubscribers() == 0 ? arm_states_.getTopic() : "";
}

std::string DriverInterface::without_publisher() const {
  return commands_.getNumPublishers() == 0 ? commands_.getTopic() : "";
}

unsigned DriverInterface::links() const {
  return arm_states_.getNumSubscribers() + leg_states_.getNumSubscribers() +
         commands_.getNumPublishers();
}

}  // namespace platform_sim
