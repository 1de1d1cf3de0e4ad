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
void Answers::listen(ros::NodeHandle& node, Link link, void (Answers::*receive)(const Message&)) {
  subscribers_.push_back(node.subscribe(topic_name(link), kQueueSize, receive, this, kNoDelay));
}

template <class Message>
void Answers::note(ros::NodeHandle& node, Link link) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
      [this, link](const boost::shared_ptr<const Message>& message) {
        lockstep_.received(link, to_ns(message->header.stamp));
      };
  subscribers_.push_back(node.subscribe<Message>(topic_name(link), kQueueSize, callback,
                                                 ros::VoidConstPtr(), kNoDelay));
}

Answers::Answers(ros::NodeHandle& node, Peer peer) : lockstep_(peer) {
  if (peer == Peer::kGuide) {
    listen(node, Link::kWrench, &Answers::receive_wrench);
    return;
  }
  note<prf_msgs::TagDetectionArray>(node, Link::kDetections);
  note<prf_msgs::TargetForecast>(node, Link::kForecast);
  listen(node, Link::kProgress, &Answers::receive_progress);
  note<prf_msgs::SkillTrajectory>(node, Link::kTrajectory);
  note<trajectory_msgs::MultiDOFJointTrajectory>(node, Link::kSetpoint);
  listen(node, Link::kCommand, &Answers::receive_command);
}

std::optional<ArmCommand> Answers::take_command() { return std::exchange(command_, std::nullopt); }

std::optional<HandWrench> Answers::take_wrench() { return std::exchange(wrench_, std::nullopt); }

std::vector<std::string> Answers::without_publisher() const {
  std::vector<std::string> names;
  for (const ros::Subscriber& subscriber : subscribers_) {
    if (subscriber.getNumPublishers() == 0) names.push_back(subscriber.getTopic());
  }
  return names;
}

unsigned Answers::publishers() const {
  unsigned count = 0;
  for (const ros::Subscriber& subscriber : subscribers_) count += subscriber.getNumPublishers();
  return count;
}

void Answers::receive_progress(const prf_msgs::ExecutionProgress& message) {
  const StampNs stamp = to_ns(message.header.stamp);
  if (!lockstep_.received_progress(stamp, to_ns(message.forecast_stamp))) return;
  finished_ = finished_ || message.state == prf_msgs::ExecutionProgress::DONE ||
              message.state == prf_msgs::ExecutionProgress::STOPPED;
}

void Answers::receive_command(const trajectory_msgs::JointTrajectory& message) {
  if (!lockstep_.received(Link::kCommand, to_ns(message.header.stamp))) return;
  command_.reset();
  try {
    command_ = to_arm_command(message);
  } catch (const std::invalid_argument& error) {
    refuse(Link::kCommand, error.what());
  }
}

void Answers::receive_wrench(const geometry_msgs::WrenchStamped& message) {
  if (!lockstep_.received(Link::kWrench, to_ns(message.header.stamp))) return;
  wrench_ = HandWrench{};
  try {
    wrench_ = to_hand_wrench(message);
  } catch (const std::invalid_argument& error) {
    refuse(Link::kWrench, error.what());
  }
}

void Answers::refuse(Link link, const std::string& why) {
  ROS_WARN_COND(refused_ % kWarnEvery == 0, "%s refused, the arm holds: %s (%u refused before)",
                topic_name(link), why.c_str(), refused_);
  ++refused_;
}

}  // namespace platform_sim
