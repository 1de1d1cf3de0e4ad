// SPDX-License-Identifier: BSD-3-Clause
#include "responses.hpp"

#include <ros/console.h>

#include <boost/function.hpp>
#include <stdexcept>
#include <utility>

namespace platform_sim {
namespace {

constexpr std::uint32_t kQueueSize = 100;
constexpr unsigned kWarnEvery = 100;  // refusals; a second of them

const auto kNoDelay = ros::TransportHints().tcpNoDelay();

}  // namespace

template <class Message>
void Responses::listen(ros::NodeHandle& node, Response response,
                       void (Responses::*receive)(const Message&)) {
  subscribers_.push_back(node.subscribe(topic_name(response), kQueueSize, receive, this, kNoDelay));
}

template <class Message>
void Responses::note(ros::NodeHandle& node, Response response) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
      [this, response](const boost::shared_ptr<const Message>& message) {
        lockstep_.received(response, prf_ros::to_core(message->header.stamp));
      };
  subscribers_.push_back(node.subscribe<Message>(topic_name(response), kQueueSize, callback,
                                                 ros::VoidConstPtr(), kNoDelay));
}

Responses::Responses(ros::NodeHandle& node, Peer peer) : lockstep_(peer) {
  if (peer == Peer::kGuide) {
    listen(node, Response::kWrench, &Responses::receive_wrench);
    return;
  }
  note<prf_msgs::TagDetectionArray>(node, Response::kDetections);
  note<prf_msgs::TargetForecast>(node, Response::kForecast);
  listen(node, Response::kProgress, &Responses::receive_progress);
  note<prf_msgs::SkillTrajectory>(node, Response::kTrajectory);
  note<trajectory_msgs::MultiDOFJointTrajectory>(node, Response::kSetpoint);
  listen(node, Response::kCommand, &Responses::receive_command);
}

std::optional<ArmCommand> Responses::take_command() {
  return std::exchange(command_, std::nullopt);
}

std::optional<HandWrench> Responses::take_wrench() { return std::exchange(wrench_, std::nullopt); }

std::vector<std::string> Responses::without_publisher() const {
  std::vector<std::string> names;
  for (const ros::Subscriber& subscriber : subscribers_) {
    if (subscriber.getNumPublishers() == 0) names.push_back(subscriber.getTopic());
  }
  return names;
}

unsigned Responses::publishers() const {
  unsigned count = 0;
  for (const ros::Subscriber& subscriber : subscribers_) count += subscriber.getNumPublishers();
  return count;
}

void Responses::receive_progress(const prf_msgs::ExecutionProgress& message) {
  const prf_core::Stamp stamp = prf_ros::to_core(message.header.stamp);
  if (!lockstep_.received_progress(stamp, prf_ros::to_core(message.forecast_stamp))) return;
  finished_ = finished_ || message.state == prf_msgs::ExecutionProgress::DONE ||
              message.state == prf_msgs::ExecutionProgress::STOPPED;
}

void Responses::receive_command(const trajectory_msgs::JointTrajectory& message) {
  if (!lockstep_.received(Response::kCommand, prf_ros::to_core(message.header.stamp))) return;
  command_.reset();
  try {
    command_ = to_arm_command(message);
  } catch (const std::invalid_argument& error) {
    refuse(Response::kCommand, error.what());
  }
}

void Responses::receive_wrench(const geometry_msgs::WrenchStamped& message) {
  if (!lockstep_.received(Response::kWrench, prf_ros::to_core(message.header.stamp))) return;
  wrench_ = HandWrench{};
  try {
    wrench_ = to_hand_wrench(message);
  } catch (const std::invalid_argument& error) {
    refuse(Response::kWrench, error.what());
  }
}

void Responses::refuse(Response response, const std::string& why) {
  ROS_WARN_COND(refused_ % kWarnEvery == 0, "%s refused, the arm holds: %s (%u refused before)",
                topic_name(response), why.c_str(), refused_);
  ++refused_;
}

}  // namespace platform_sim
