// SPDX-License-Identifier: BSD-3-Clause
#include "driver_output.hpp"

#include <std_msgs/Float64MultiArray.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <prf_ros/driver_messages.hpp>

#include <cmath>
#include <functional>
#include <utility>

namespace prf_drivers {
namespace {

constexpr std::uint32_t kQueue = 10;  // what waits longer is of no use any more
constexpr double kDegrees = 180.0 / M_PI;

template <typename Message>
class Output : public DriverOutput {
 public:
  using Words = std::function<Message(const DriverCommand&)>;

  Output(ros::NodeHandle& node, const std::string& topic, Words words)
      : publisher_(node.advertise<Message>(topic, kQueue)), words_(std::move(words)) {}

  void send(const DriverCommand& command) override { publisher_.publish(words_(command)); }
  [[nodiscard]] unsigned subscribers() const override { return publisher_.getNumSubscribers(); }

 private:
  ros::Publisher publisher_;
  Words words_;
};

std_msgs::Float64MultiArray group_message(const Eigen::VectorXd& values) {
  std_msgs::Float64MultiArray message;
  message.data.assign(values.begin(), values.end());
  return message;
}

// Stamp 0: at once. The point lies `horizon` ahead, so its position goes on with the velocity from
// the end of the tick that it was computed for; the controller would else lag behind.
trajectory_msgs::JointTrajectory trajectory_message(const AdapterNodeParams& params,
                                                    const DriverCommand& command) {
  const double ahead = params.horizon - params.driver.period;
  const Eigen::VectorXd position = command.position + ahead * command.velocity;
  trajectory_msgs::JointTrajectory message;
  message.joint_names = params.driver.joints;
  message.points.resize(1);
  auto& point = message.points.front();
  point.positions.assign(position.begin(), position.end());
  point.velocities.assign(command.velocity.begin(), command.velocity.end());
  point.time_from_start = ros::Duration(params.horizon);
  return message;
}

prf_ros::kinova::JointVelocity kinova_message(const DriverCommand& command) {
  prf_ros::kinova::JointVelocity message;
  for (Eigen::Index i = 0; i < command.velocity.size(); ++i) {
    message.joints.at(static_cast<std::size_t>(i)) =
        static_cast<float>(kDegrees * command.velocity[i]);
  }
  return message;
}

prf_ros::kortex::BaseJointSpeeds kortex_message(const DriverCommand& command) {
  prf_ros::kortex::BaseJointSpeeds message;
  for (Eigen::Index i = 0; i < command.velocity.size(); ++i) {
    message.joint_speeds.push_back(
        {static_cast<std::uint32_t>(i), static_cast<float>(command.velocity[i]), 0});
  }
  return message;
}

}  // namespace

std::unique_ptr<DriverOutput> make_output(ros::NodeHandle& node, const AdapterNodeParams& params) {
  const std::string& topic = params.driver.command_topic;
  switch (params.driver.speaks) {
    case Speaks::kVelocityGroup:
      return std::make_unique<Output<std_msgs::Float64MultiArray>>(
          node, topic,
          [](const DriverCommand& command) { return group_message(command.velocity); });
    case Speaks::kPositionGroup:
      return std::make_unique<Output<std_msgs::Float64MultiArray>>(
          node, topic,
          [](const DriverCommand& command) { return group_message(command.position); });
    case Speaks::kTrajectory:
      return std::make_unique<Output<trajectory_msgs::JointTrajectory>>(
          node, topic,
          [params](const DriverCommand& command) { return trajectory_message(params, command); });
    case Speaks::kKinova:
      return std::make_unique<Output<prf_ros::kinova::JointVelocity>>(node, topic, kinova_message);
    case Speaks::kKortex:
      return std::make_unique<Output<prf_ros::kortex::BaseJointSpeeds>>(node, topic,
                                                                        kortex_message);
  }
  throw std::invalid_argument("driver/speaks is no kind of driver");
}

}  // namespace prf_drivers
